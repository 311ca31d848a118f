// Solves A dv = b within a filter: S (A dv - b) = 0 and (I - S) dv = z. One verb, and a report that is data.
//   All vectors, and the filter's particle numbers, are in row order (solver/matrix/block_matrix.h).
//   A [kg], b [N s], dv [m/s]; the residual is |S (b - A dv)| [N s], computed afresh at the end, outside the
//   iteration.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/filter.h"
#include "solver/matrix/block_matrix.h"

namespace drape {

enum class StopReason {
  converged,
  iteration_limit,  // stopped early: the residual says how far it came
  indefinite,       // a direction of negative or zero curvature: A is not positive definite
  not_finite,       // nan or inf in A, b or the guess
};
std::string_view name(StopReason reason);

struct LinearOptions {
  double tolerance = 1e-6;  // of the residual, relative to the larger of |S (b - A z)| and scale
  int max_iterations = 0;   // 0: 1000 + 20 sqrt(rows)
  double scale = 0;         // N s, an impulse that is known to act even where forces cancel in b: h |m g|
  std::vector<double>* history =
      nullptr;  // when given: gets the relative residual of every iteration, from 0
};

struct LinearReport {
  int iterations = 0;
  double residual = 0;          // relative, as in LinearOptions::tolerance
  double residual_impulse = 0;  // N s, |S (b - A dv)|
  StopReason reason = StopReason::converged;
  double setup_ms = 0;  // projection, preconditioner or factor; 0 of it where it was reused
  double solve_ms = 0;  // all else
  int analyses = 0;     // how often the pattern was looked at anew: 0 while it stands
  std::string note;     // what the user should know: a shifted factor, slow kernels of a library
};

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual std::string_view name() const = 0;
  // dv: in, the guess (its locked part is replaced by z); out, the solution.
  virtual LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter,
                             const LinearOptions& options, VecX& dv) = 0;
};

// "mpcg", and what linear_solvers() lists. Throws InputError for any other name.
std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name);

struct LinearSolverInfo {
  std::string_view name, summary;
};
std::vector<LinearSolverInfo> linear_solvers();  // of this build

}  // namespace drape
