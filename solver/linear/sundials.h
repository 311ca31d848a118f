// What all that wraps SUNDIALS shares.
//   SUNDIALS calls our assembly and our linear solver through a SUNLinearSolver of our own, which it asks for
//   the solution of its Newton system; it never sees a matrix.                     [Hindmarsh et al. 2005]
//   Its vectors are views of ours, with serial arithmetic in a fixed order.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>

#include <cstdlib>
#include <string>

#include "mesh/base/vectors.h"

namespace drape::internal::sundials {

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

// The handler of errors: it prints nothing, because the flag that a call returns has the error, too.
inline void say_nothing(int, const char*, const char*, char*, void*) {}

// Copies the name of a flag and frees the original, which SUNDIALS leaves to the caller.
inline std::string taken(char* text) {
  std::string copy = text;
  std::free(text);
  return copy;
}

// The linear solver that calls owner.solve_linear(x, b), which returns 0, or 1 when a smaller step may help,
// or -1. type: matrix-embedded; or direct for KINSOL, which asks for a matrix (it gets an empty one).
template <class Owner, SUNLinearSolver_Type type>
SUNLinearSolver our_solver(Owner& owner, SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  solver->content = &owner;
  solver->ops->gettype = [](SUNLinearSolver) { return type; };
  solver->ops->solve = [](SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) {
    const int failed = static_cast<Owner*>(s->content)->solve_linear(x, b);
    // SUNDIALS takes a number that it does not know for success.
    return failed > 0 ? SUNLS_CONV_FAIL : failed < 0 ? SUNLS_PACKAGE_FAIL_UNREC : SUNLS_SUCCESS;
  };
  return solver;
}

}  // namespace drape::internal::sundials
