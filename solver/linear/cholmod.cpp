// LL^T by CHOLMOD of SuiteSparse on the projected system (solver/linear/projected.h). The analysis is kept
// while the serial of the matrix does not change.                            [Chen, Davis, Hager &
// Rajamanickam 2008]
//   The supernodal part of CHOLMOD is GPL (README.md says what that means). Without SuiteSparse this file is
//   not built.
#include <cholmod.h>
#include <dlfcn.h>

#include <mutex>
#include <stdexcept>

#include "mesh/base/stopwatch.h"
#include "solver/linear/projected.h"
#include "solver/linear/residual.h"

namespace drape {

using namespace internal;

namespace {

// Says why the BLAS that CHOLMOD uses is slow; empty when it is not. OpenBLAS may mistake a new processor for
// an old one, and the reference BLAS is slow on any.
std::string blas_note() {
  using CoreName = char* (*)();
  const auto core_name = reinterpret_cast<CoreName>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  if (!core_name)
    return "BLAS is not OpenBLAS: several times slower; install libopenblas0-pthread (as Debian calls it)";
#if defined(__x86_64__)
  const std::string core = core_name();
  const bool old_kernels = core == "Prescott" || core == "Core2" || core == "Penryn" || core == "Nehalem";
  if (old_kernels && __builtin_cpu_supports("avx2"))
    return "OpenBLAS runs its " + core +
           " kernels: set OPENBLAS_CORETYPE=" + (__builtin_cpu_supports("avx512f") ? "SkylakeX" : "Haswell");
#endif
  return {};
}

// While one of these lives, BLAS runs in one thread, because its sums would depend on the number of threads.
// The setting belongs to the whole process: the first of several that live at once remembers what it was, and
// the last one restores it.
class OneBlasThread {
 public:
  OneBlasThread() {
    Shared& s = shared();
    if (!s.count_of_blas || !s.set_count_of_blas) return;
    const std::lock_guard lock(s.mutex);
    if (s.living++ > 0) return;
    s.before = s.count_of_blas();
    s.set_count_of_blas(1);
  }
  ~OneBlasThread() {
    Shared& s = shared();
    if (!s.count_of_blas || !s.set_count_of_blas) return;
    const std::lock_guard lock(s.mutex);
    if (--s.living == 0) s.set_count_of_blas(s.before);
  }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  struct Shared {
    int (*count_of_blas)() =
        reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));  // null: not OpenBLAS
    void (*set_count_of_blas)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT,
                                                                           "openblas_set_num_threads"));
    std::mutex mutex;
    int living = 0, before = 1;
  };
  static Shared& shared() {
    static Shared only;
    return only;
  }
};

class Cholmod final : public LinearSolver {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_AUTO;
    common_.final_ll = 1;  // LL^T only, so that an indefinite matrix is found and not factorised
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  ~Cholmod() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  std::string_view name() const override { return "cholmod"; }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report;
    report.note = blas_note();
    const OneBlasThread calm;
    {
      const Stopwatch watch(report.setup_ms);
      system_.project(A, b, filter, options);
      factorise(A.serial(), report);
    }
    if (report.reason != StopReason::converged) return report;
    {
      const Stopwatch watch(report.solve_ms);
      cholmod_dense right = {};
      right.nrow = right.d = right.nzmax = static_cast<std::size_t>(b.size());
      right.ncol = 1;
      right.x = const_cast<double*>(system_.right_side().data());
      right.xtype = CHOLMOD_REAL;
      right.dtype = CHOLMOD_DOUBLE;
      cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &right, &common_);
      if (!solution) give_up();
      dv = Eigen::Map<const VecX>(static_cast<const double*>(solution->x), b.size());
      cholmod_free_dense(&solution, &common_);
      finish(A, b, filter, options, system_.reference(), dv, scratch_, report);
    }
    return report;
  }

 private:
  void factorise(std::uint64_t pattern, LinearReport& report) {
    cholmod_sparse matrix = view(system_.matrix());
    if (analysed_ != pattern) {
      cholmod_free_factor(&factor_, &common_);
      factor_ = cholmod_analyze(&matrix, &common_);
      if (!factor_) give_up();
      analysed_ = pattern;
      report.analyses = 1;
    }
    cholmod_factorize(&matrix, factor_, &common_);
    if (common_.status < 0) give_up();
    if (common_.status != CHOLMOD_OK) report.reason = StopReason::indefinite;
  }

  [[noreturn]] void give_up() {
    analysed_ = 0;
    throw std::runtime_error("cholmod: not enough memory for the factor, or it is too large");
  }

  static cholmod_sparse view(const ProjectedSystem::Matrix& m) {
    cholmod_sparse s = {};
    s.nrow = s.ncol = static_cast<std::size_t>(m.rows());
    s.nzmax = static_cast<std::size_t>(m.nonZeros());
    s.p = const_cast<int*>(m.outerIndexPtr());
    s.i = const_cast<int*>(m.innerIndexPtr());
    s.x = const_cast<double*>(m.valuePtr());
    s.stype = -1;  // symmetric, lower triangle
    s.itype = CHOLMOD_INT;
    s.xtype = CHOLMOD_REAL;
    s.dtype = CHOLMOD_DOUBLE;
    s.sorted = s.packed = 1;
    return s;
  }

  ProjectedSystem system_;
  cholmod_common common_ = {};
  cholmod_factor* factor_ = nullptr;
  std::uint64_t analysed_ = 0;
  VecX scratch_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod() { return std::make_unique<Cholmod>(); }

}  // namespace drape
