// A linear solver that passes the work on to another solver and keeps the system that it was given. In this
// way the systems of a run can be collected without changing the integrator.
#pragma once

#include <optional>

#include "solver/linear/linear_solver.h"

namespace drape::app {

struct LinearSystem {
  BlockMatrix A;
  VecX b;
  Filter filter;
  LinearOptions options;
  VecX guess;     // m/s, in row order, as the integrator gave it for the first solve with this matrix
  VecX solution;  // m/s, from the solver that the run goes on with
};

struct SystemRecording {
  bool on = false;                   // when false, nothing is copied
  bool keep_first = false;           // of several solves, whether the system of the first one is kept
  std::optional<LinearSystem> last;  // the last system solved while on
};

class RecordingSolver final : public LinearSolver {
 public:
  // Keeps a reference to `recording`.
  RecordingSolver(std::unique_ptr<LinearSolver> solver, SystemRecording& recording)
      : solver_(std::move(solver)), recording_(recording) {}

  std::string_view name() const override { return solver_->name(); }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    if (!recording_.on || (recording_.keep_first && recording_.last))
      return solver_->solve(A, b, filter, options, dv);
    const bool same_matrix = recording_.last && recording_.last->A.fill() == A.fill();
    VecX guess = same_matrix ? recording_.last->guess : dv;
    recording_.last = LinearSystem{A, b, filter, options, std::move(guess), {}};
    recording_.last->options.history = nullptr;
    LinearReport report = solver_->solve(A, b, filter, options, dv);
    recording_.last->solution = dv;
    return report;
  }

 private:
  std::unique_ptr<LinearSolver> solver_;
  SystemRecording& recording_;
};

}  // namespace drape::app
