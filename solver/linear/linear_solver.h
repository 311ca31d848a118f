// Solves A dv = b within a filter: S (A dv - b) = 0 and (I - S) dv = z. The interface is one function, which
// returns a report that is plain data.
//   All vectors, and the filter's particle numbers, are in row order (solver/matrix/block_matrix.h).
//   A [kg], b [N s], dv [m/s]; the residual is |S (b - A dv)| [N s], computed anew at the end, outside the
//   iteration.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/filter.h"
#include "solver/matrix/block_matrix.h"

namespace drape {

enum class StopReason {
  converged,
  iteration_limit,  // stopped early; the residual says how far it came
  indefinite,       // met a direction of negative or zero curvature: A is not positive definite
  not_finite,       // met nan or inf in A, b or the guess
};
std::string_view name(StopReason reason);

constexpr double least_tolerance = 1e-14;  // that round-off lets be reached

struct LinearOptions {
  double tolerance =
      1e-6;  // of the residual, relative to the larger of |S (b - A z)| and scale, but to most_scale at most, and
             // no less than what round-off lets be reached
  int max_iterations = 0;  // 0: 1000 + 20 sqrt(rows)
  double scale = 0;        // impulse that acts even where forces cancel in b [N s]: h |m g|
  double most_scale = std::numeric_limits<double>::infinity();  // N s
  std::vector<double>* history =
      nullptr;  // when given, gets the relative residual of every iteration, from 0 on
};

struct LinearReport {
  int iterations = 0;
  double residual = 0;          // relative, as in LinearOptions::tolerance
  double residual_impulse = 0;  // |S (b - A dv)| [N s]
  StopReason reason = StopReason::converged;
  double setup_ms = 0;  // time of projection, preconditioner or factor [ms]; what is reused takes none
  double solve_ms = 0;  // time of everything else [ms]
  int analyses = 0;     // how often the blocks were analysed; 0 while they do not change
  double shift = 0;  // incomplete Cholesky was built for A + shift diag(A), because it breaks down for less
  std::string
      note;  // what else the user should know: slow kernels of a library, a preconditioner that failed
  std::string_view method = {};  // the name of the solver that "auto" took; empty for the others
};

// What the user should know of the solve, shift and note; empty when there is nothing.
std::string remark(const LinearReport& report);

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual std::string_view name() const = 0;
  // dv goes in as the guess and comes out as the solution. An iterative solver replaces the locked part of
  // the guess by z, and starts from the multiple of the rest that is nearest to the solution in the norm of
  // A.
  virtual LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter,
                             const LinearOptions& options, VecX& dv) = 0;
};

// Makes "mpcg" or any other solver that linear_solvers() lists. Throws InputError for any other name.
std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name);

struct LinearSolverInfo {
  std::string_view name, summary;
};
std::vector<LinearSolverInfo> linear_solvers();  // those of this build
// Says that this build lacks the linear solver of that name, and what to install for it; empty for any other
// name.
std::string missing_linear_solver(std::string_view name);

}  // namespace drape
