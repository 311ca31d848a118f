// A linear solver that lets another one do the work and keeps what it was given: so the systems of a run can
// be taken out without the integrator knowing.
#pragma once

#include <optional>

#include "solver/linear/linear_solver.h"

namespace drape {

struct LinearSystem {
  BlockMatrix A;
  VecX b;
  Filter filter;
  LinearOptions options;
  VecX guess;     // m/s, row order, as the integrator gave it
  VecX solution;  // m/s, of the solver that decided the path
};

struct SystemRecording {
  bool on = false;                   // off: nothing is copied
  bool keep_first = false;           // of several solves, the system of the first stays
  std::optional<LinearSystem> last;  // the last system solved while on
};

class RecordingSolver final : public LinearSolver {
 public:
  // Keeps a reference to the recording.
  RecordingSolver(std::unique_ptr<LinearSolver> solver, SystemRecording& recording)
      : solver_(std::move(solver)), recording_(recording) {}

  std::string_view name() const override { return solver_->name(); }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    if (!recording_.on || (recording_.keep_first && recording_.last))
      return solver_->solve(A, b, filter, options, dv);
    recording_.last = LinearSystem{A, b, filter, options, dv, {}};
    recording_.last->options.history = nullptr;
    LinearReport report = solver_->solve(A, b, filter, options, dv);
    recording_.last->solution = dv;
    return report;
  }

 private:
  std::unique_ptr<LinearSolver> solver_;
  SystemRecording& recording_;
};

}  // namespace drape
