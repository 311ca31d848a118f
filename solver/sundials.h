// What the integrators that wrap SUNDIALS share. Internal to the library (not installed).
//   SUNDIALS calls our assembly and our linear solver through a SUNLinearSolver of our own, which it asks for
//   the solution of its Newton system; it never sees a matrix.                     [Hindmarsh et al. 2005]
//   Its vectors are views of ours, with serial arithmetic in a fixed order.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>

#include <cstdlib>
#include <string>

#include "solver/integrator.h"

namespace drape::sundials {

class Context {  // its owners cannot be copied either
 public:
  Context() { SUNContext_Create(nullptr, &context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { SUNContext_Free(&context_); }
  operator SUNContext() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

// An N_Vector over the numbers of a VecX, which must outlive it and keep its size.
class View {
 public:
  View(VecX& v, SUNContext context) : vector_(N_VMake_Serial(v.size(), v.data(), context)) {}
  View(const View&) = delete;
  View& operator=(const View&) = delete;
  ~View() { N_VDestroy(vector_); }
  operator N_Vector() const { return vector_; }

 private:
  N_Vector vector_;
};

inline Eigen::Map<VecX> numbers(N_Vector v) { return {N_VGetArrayPointer(v), N_VGetLength(v)}; }

// What is reported stands in the flag, too.
inline void say_nothing(int, const char*, const char*, char*, void*) {}

// The name of a flag, which SUNDIALS leaves to the caller to free.
inline std::string taken(char* text) {
  std::string copy = text;
  std::free(text);
  return copy;
}

// The linear solver that calls owner.solve_linear(x, b): 0, or 1 when a smaller step may help, or -1.
// type: matrix-embedded, or direct for KINSOL, which asks for a matrix (there it is an empty one).
template <class Owner, SUNLinearSolver_Type type>
SUNLinearSolver our_solver(Owner& owner, SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  solver->content = &owner;
  solver->ops->gettype = [](SUNLinearSolver) { return type; };
  solver->ops->solve = [](SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) {
    const int failed = static_cast<Owner*>(s->content)->solve_linear(x, b);
    // A number that SUNDIALS does not know it takes for success.
    return failed > 0 ? SUNLS_CONV_FAIL : failed < 0 ? SUNLS_PACKAGE_FAIL_UNREC : SUNLS_SUCCESS;
  };
  return solver;
}

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
