// Newton's matrix for the integrators of SUNDIALS: assembled by our forces, solved by our linear solver.
// Internal to the library (not installed).
#pragma once

#include <memory>
#include <utility>

#include "solver/linear/linear_solver.h"
#include "solver/linear/sundials.h"
#include "solver/system/system.h"

namespace drape::sundials {

// A = M + c D + c^2 K at (x, v) and solves within a filter, all in particle order.
class Newton {
 public:
  Newton(System& system, std::unique_ptr<LinearSolver> solver)
      : system_(system), solver_(std::move(solver)) {}

  // Also b = c (f - K y), without gravity.
  void assemble(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness) {
    const auto& pattern = system_.bind();
    if (!A_ || &A_->pattern() != pattern.get()) A_ = std::make_unique<BlockMatrix>(pattern);
    A_->set_to_mass(system_.masses());
    b_.setZero(x.size());
    for (const auto& force : system_.forces()) force->add_linearised(x, v, y, c, stiffness, *A_, b_);
  }
  void add_to_diagonal(int particle, const Mat3& block) {
    A_->at(A_->pattern().diagonal(A_->pattern().row_of()[static_cast<std::size_t>(particle)])) += block;
  }
  const VecX& right_side() const { return b_; }
  const BlockMatrix& matrix() const { return *A_; }

  // A dv = b; dv: in, the guess.
  LinearReport solve(const VecX& b, const Filter& filter, const LinearOptions& options, VecX& dv) {
    const BlockPattern& pattern = A_->pattern();
    b_rows_.resize(b.size());
    dv_rows_.resize(b.size());
    to_rows(pattern, b, b_rows_);
    to_rows(pattern, dv, dv_rows_);
    filter_ = filter;
    filter_.renumber(pattern.row_of());
    const LinearReport report = solver_->solve(*A_, b_rows_, filter_, options, dv_rows_);
    to_particles(pattern, dv_rows_, dv);
    return report;
  }

 private:
  System& system_;
  std::unique_ptr<LinearSolver> solver_;
  std::unique_ptr<BlockMatrix> A_;
  Filter filter_;
  VecX b_, b_rows_, dv_rows_;
};

}  // namespace drape::sundials
