// "petsc": the prefiltered system by PETSc's KSP CG, preconditioned by its algebraic multigrid GAMG.
//   None of PETSc's formats takes blocks of three in memory that it does not own ("block size 3 > 1 is not
//   supported yet"), so PETSc gets a copy in the format BAIJ. GAMG wants scalar rows and gets a conversion.
//   PETSc runs in this one process; the calls are those of runs under mpirun.
//                                                             [Balay et al., PETSc Users Manual, 3.18]
#include <petscksp.h>

#include "mesh/base/stopwatch.h"
#include "solver/linear/projected_block.h"
#include "solver/linear/residual.h"

namespace drape {

using namespace internal;

namespace {

// Starts PETSc once in a process; it is stopped when the process ends.
void start_petsc() {
  static const bool started = [] {
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
    PetscInitializeNoArguments();
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
    std::atexit([] { PetscFinalize(); });
    return true;
  }();
  static_cast<void>(started);
}

class Petsc final : public LinearSolver {
 public:
  Petsc() {
    start_petsc();
    KSPCreate(PETSC_COMM_SELF, &ksp_);
    KSPSetType(ksp_, KSPCG);
    KSPSetNormType(ksp_, KSP_NORM_UNPRECONDITIONED);
    KSPSetInitialGuessNonzero(ksp_, PETSC_TRUE);
    PC pc = nullptr;
    KSPGetPC(ksp_, &pc);
    PCSetType(pc, PCGAMG);
    PCGAMGSetThreshold(pc, threshold_, 1);
    PCGAMGSetReuseInterpolation(pc, PETSC_TRUE);
  }
  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;
  ~Petsc() override {
    release();
    KSPDestroy(&ksp_);
  }

  std::string_view name() const override { return "petsc"; }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report;
    z_.resize(b.size());
    right_.resize(b.size());
    {
      const Stopwatch watch(report.setup_ms);
      hand_over(A, filter, report);
    }
    if (report.reason != StopReason::converged) return report;
    {
      const Stopwatch watch(report.solve_ms);
      const double reference = reference_impulse(A, b, filter, options, z_, right_);
      dv *= best_multiple(A, filter, right_, dv, scratch_);
      if (right_.allFinite() && dv.allFinite() && reference > 0)
        iterate(A.rows(), options, reference, dv, report);
      dv += z_;
      const StopReason stopped = report.reason;
      finish(A, b, filter, options, reference, dv, scratch_, report);
      if (stopped != StopReason::converged && report.reason != StopReason::not_finite)
        report.reason = stopped;
    }
    return report;
  }

 private:
  void release() {
    MatDestroy(&rows_);
    MatDestroy(&matrix_);
  }

  void hand_over(const BlockMatrix& A, const Filter& filter, LinearReport& report) {
    const BlockPattern& pattern = A.pattern();
    std::vector<int> entry_of_row;
    const ProjectedBlocks projected(A, filter, entry_of_row);
    for (int r = 0; r < A.rows(); ++r)
      if (!positive_definite(projected.block(pattern.diagonal(r), r, r)))
        report.reason = StopReason::indefinite;
    if (report.reason != StopReason::converged) return;
    const bool same = serial_ == A.serial();
    if (!same) find_below_diagonal(A, below_);
    start_.assign(1, 0);
    column_.clear();
    block_.clear();
    for (int r = 0; r < A.rows(); ++r) {
      const auto add = [&](int column, const Mat3& block) {
        column_.push_back(column);
        block_.push_back(block);
      };
      below_.in_column(r, [&](int c, int slot) { add(c, projected.block(slot, c, r).transpose()); });
      A.each(r, [&](int c, int slot) { add(c, projected.block(slot, r, c)); });
      start_.push_back(static_cast<PetscInt>(column_.size()));
    }
    MatDestroy(&matrix_);
    MatCreate(PETSC_COMM_SELF, &matrix_);
    MatSetSizes(matrix_, 3 * A.rows(), 3 * A.rows(), 3 * A.rows(), 3 * A.rows());
    MatSetType(matrix_, MATSEQBAIJ);
    MatSetOption(matrix_, MAT_ROW_ORIENTED, PETSC_FALSE);
    MatSeqBAIJSetPreallocationCSR(matrix_, 3, start_.data(), column_.data(), block_.front().data());
    if (!same) {
      KSPReset(ksp_);
      MatDestroy(&rows_);
    }
    MatConvert(matrix_, MATAIJ, rows_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &rows_);
    MatSetBlockSize(rows_, 3);
    KSPSetOperators(ksp_, matrix_, rows_);
    if (KSPSetUp(ksp_) != 0) report.reason = StopReason::indefinite;
    if (!same) ++report.analyses;
    serial_ = report.reason == StopReason::converged ? A.serial() : 0;
  }

  void iterate(int rows, const LinearOptions& options, double reference, VecX& y, LinearReport& report) {
    KSPSetTolerances(ksp_, 0, options.tolerance * reference, 1e30, iteration_limit(options, rows));
    if (options.history) {
      curve_.resize(static_cast<std::size_t>(iteration_limit(options, rows)) + 1);
      KSPSetResidualHistory(ksp_, curve_.data(), static_cast<PetscInt>(curve_.size()), PETSC_TRUE);
    }
    Vec right = nullptr, solution = nullptr;
    VecCreateSeqWithArray(PETSC_COMM_SELF, 3, 3 * rows, right_.data(), &right);
    VecCreateSeqWithArray(PETSC_COMM_SELF, 3, 3 * rows, y.data(), &solution);
    const PetscErrorCode error = KSPSolve(ksp_, right, solution);
    VecDestroy(&right);
    VecDestroy(&solution);
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    PetscInt iterations = 0, points = 0;
    KSPGetConvergedReason(ksp_, &reason);
    KSPGetIterationNumber(ksp_, &iterations);
    report.iterations = static_cast<int>(iterations);
    if (options.history) {
      KSPGetResidualHistory(ksp_, nullptr, &points);
      for (PetscInt k = 0; k < points; ++k) options.history->push_back(curve_[k] / reference);
    }
    if (error != 0 || reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC ||
        reason == KSP_DIVERGED_PC_FAILED)
      report.reason = StopReason::indefinite;
  }

  KSP ksp_ = nullptr;
  Mat matrix_ = nullptr, rows_ = nullptr;  // matrix_ is in blocks; rows_ is the same in scalar rows
  PetscReal threshold_[1] = {-1};          // drops no coupling: with 0.08 a solve took fifteen times as long
  std::uint64_t serial_ = 0;
  Mirror below_;
  std::vector<PetscInt> start_, column_;
  std::vector<Mat3> block_;
  std::vector<double> curve_;
  VecX z_, right_, scratch_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_petsc() { return std::make_unique<Petsc>(); }

}  // namespace drape
