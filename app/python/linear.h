// Linear solvers and linear systems in the form that Python sees.
#pragma once

#include <memory>

#include "app/compare/recording_solver.h"
#include "app/python/bindings.h"

namespace drape::app::python {

using Solver = std::shared_ptr<LinearSolver>;

Solver solver_of(const py::object& given);  // `given` is a name or a solver

// A solver that others may own too.
class SharedSolver final : public LinearSolver {
 public:
  explicit SharedSolver(Solver solver) : solver_(std::move(solver)) {}
  std::string_view name() const override { return solver_->name(); }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    return solver_->solve(A, b, filter, options, dv);
  }

 private:
  Solver solver_;
};

// Makes a RecordingSolver that shares the solver. It keeps a reference to `recording`.
std::unique_ptr<LinearSolver> recorded(const Solver& solver, SystemRecording& recording);

// The last system that was solved while recording, or None. It is not copied; a later system takes its place.
py::object last_system(const SystemRecording& recording);

}  // namespace drape::app::python
