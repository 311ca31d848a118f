// "sundials-pcg": the prefiltered system by SUNLinSol_PCG of SUNDIALS, with our matrix and preconditioner.
//   (S A S + I - S) y = S (b - A z),   dv = y + z                              [Hestenes & Stiefel 1952]
#include <sunlinsol/sunlinsol_pcg.h>

#include "mesh/base/stopwatch.h"
#include "solver/linear/preconditioner.h"
#include "solver/linear/residual.h"
#include "solver/linear/sundials.h"

namespace drape {

using namespace internal;

namespace {

class SundialsPcg final : public LinearSolver {
 public:
  SundialsPcg(std::string name, std::unique_ptr<Preconditioner> preconditioner)
      : name_(std::move(name)), preconditioner_(std::move(preconditioner)) {}
  SundialsPcg(const SundialsPcg&) = delete;
  SundialsPcg& operator=(const SundialsPcg&) = delete;
  ~SundialsPcg() override { SUNLinSolFree(pcg_); }

  std::string_view name() const override { return name_; }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report;
    A_ = &A;
    filter_ = &filter;
    {
      const Stopwatch watch(report.setup_ms);
      resize(b.size());
      // SUNDIALS' iteration cannot be interrupted when a kept preconditioner stops working, so none is kept.
      preconditioner_->forget();
      if (!preconditioner_->prepare(A, filter, report)) report.reason = StopReason::indefinite;
    }
    if (report.reason != StopReason::converged) return report;
    {
      const Stopwatch watch(report.solve_ms);
      const double reference = reference_impulse(A, b, filter, options, z_, right_);
      y_ = dv;
      y_ *= best_multiple(A, filter, right_, y_, x_);
      iterate(A.rows(), options, reference, report);
      dv = y_ + z_;
      finish(A, b, filter, options, reference, dv, x_, report);
    }
    if (report.reason == StopReason::converged && broke_down_) report.reason = StopReason::indefinite;
    return report;
  }

 private:
  void resize(Eigen::Index n) {
    if (y_.size() == n) return;
    for (VecX* vector : {&y_, &z_, &right_, &x_, &Ax_}) vector->setZero(n);
    SUNLinSolFree(pcg_);
    const sundials::View like(y_, context_);
    pcg_ = SUNLinSol_PCG(like, SUN_PREC_LEFT, 0, context_);
    SUNLinSolSetATimes(pcg_, this, [](void* self, N_Vector x, N_Vector Ax) {
      return static_cast<SundialsPcg*>(self)->multiply(x, Ax);
    });
    SUNLinSolSetPreconditioner(
        pcg_, this, [](void*) { return 0; },
        [](void* self, N_Vector r, N_Vector s, realtype, int) {
          return static_cast<SundialsPcg*>(self)->precondition(r, s);
        });
    SUNLinSolInitialize(pcg_);
    SUNLinSolSetup(pcg_, nullptr);
  }

  void iterate(int rows, const LinearOptions& options, double reference, LinearReport& report) {
    broke_down_ = false;
    if (!right_.allFinite() || !y_.allFinite()) return;  // the residual will show it
    if (reference == 0) {
      y_.setZero();
      return;
    }
    SUNLinSol_PCGSetMaxl(pcg_, iteration_limit(options, rows));
    const sundials::View y(y_, context_), right(right_, context_);
    const int flag = SUNLinSolSolve(pcg_, nullptr, y, right, options.tolerance * reference);
    report.iterations = SUNLinSolNumIters(pcg_);
    broke_down_ = flag != SUNLS_SUCCESS && flag != SUNLS_RES_REDUCED && flag != SUNLS_CONV_FAIL;
  }

  // S A S x + (I - S) x
  int multiply(N_Vector x, N_Vector product) {
    x_ = sundials::numbers(x);
    filter_->apply(x_);
    A_->multiply(x_, Ax_);
    filter_->apply(Ax_);
    for (const FilterEntry& e : filter_->entries())
      Ax_.segment<3>(3 * e.particle) +=
          sundials::numbers(x).segment<3>(3 * e.particle) - x_.segment<3>(3 * e.particle);
    sundials::numbers(product) = Ax_;
    return 0;
  }

  int precondition(N_Vector r, N_Vector s) {
    x_ = sundials::numbers(r);
    preconditioner_->apply(x_, Ax_);
    filter_->apply(Ax_);
    sundials::numbers(s) = Ax_;
    return 0;
  }

  std::string name_;
  std::unique_ptr<Preconditioner> preconditioner_;
  sundials::Context context_;
  SUNLinearSolver pcg_ = nullptr;
  const BlockMatrix* A_ = nullptr;
  const Filter* filter_ = nullptr;
  VecX y_, z_, right_, x_, Ax_;
  bool broke_down_ = false;
};

}  // namespace

std::unique_ptr<LinearSolver> make_sundials_pcg(std::string name,
                                                std::unique_ptr<Preconditioner> preconditioner) {
  return std::make_unique<SundialsPcg>(std::move(name), std::move(preconditioner));
}

}  // namespace drape
