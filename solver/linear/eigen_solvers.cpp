// Eigen's own solvers on the projected system (solver/linear/projected.h), as a plain baseline to compare
// with.
//   eigen-ldlt  SimplicialLDLT, AMD ordering
//   eigen-cg    ConjugateGradient with IncompleteCholesky
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>

#include "mesh/base/stopwatch.h"
#include "solver/linear/projected.h"
#include "solver/linear/residual.h"

namespace drape {

using namespace internal;

namespace {

class EigenLdlt final : public LinearSolver {
 public:
  std::string_view name() const override { return "eigen-ldlt"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report;
    {
      const Stopwatch watch(report.setup_ms);
      system_.project(A, b, filter, options);
      if (analysed_ != A.serial()) {
        factor_.analyzePattern(system_.matrix());
        analysed_ = A.serial();
        report.analyses = 1;
      }
      factor_.factorize(system_.matrix());
      if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0))
        report.reason = StopReason::indefinite;
    }
    if (report.reason != StopReason::converged) return report;
    {
      const Stopwatch watch(report.solve_ms);
      dv = factor_.solve(system_.right_side());
      finish(A, b, filter, options, system_.reference(), dv, scratch_, report);
    }
    return report;
  }

 private:
  ProjectedSystem system_;
  Eigen::SimplicialLDLT<ProjectedSystem::Matrix, Eigen::Lower> factor_;
  std::uint64_t analysed_ = 0;
  VecX scratch_;
};

class EigenCg final : public LinearSolver {
 public:
  std::string_view name() const override { return "eigen-cg"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report;
    double right = 0;
    {
      const Stopwatch watch(report.setup_ms);
      system_.project(A, b, filter, options);
      right = system_.right_side().norm();
      if (!std::isfinite(right)) report.reason = StopReason::not_finite;
      if (right > 0 && report.reason == StopReason::converged) {
        cg_.setMaxIterations(iteration_limit(options, A.rows()));
        cg_.setTolerance(options.tolerance * system_.reference() / right);
        cg_.compute(system_.matrix());
        if (cg_.info() != Eigen::Success) report.reason = StopReason::indefinite;
      }
    }
    if (report.reason != StopReason::converged) return report;
    {
      const Stopwatch watch(report.solve_ms);
      if (right == 0) {
        dv.setZero();
      } else {
        dv *= best_multiple(A, filter, system_.right_side(), dv, scratch_);
        dv = cg_.solveWithGuess(system_.right_side(), dv).eval();
        report.iterations = static_cast<int>(cg_.iterations());
      }
      finish(A, b, filter, options, system_.reference(), dv, scratch_, report);
    }
    return report;
  }

 private:
  ProjectedSystem system_;
  Eigen::ConjugateGradient<ProjectedSystem::Matrix, Eigen::Lower, Eigen::IncompleteCholesky<double>> cg_;
  VecX scratch_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_eigen_ldlt() { return std::make_unique<EigenLdlt>(); }
std::unique_ptr<LinearSolver> make_eigen_cg() { return std::make_unique<EigenCg>(); }

}  // namespace drape
