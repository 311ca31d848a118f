// An approximate inverse of the projected matrix S A S + I - S, for the conjugate gradient.
//   s = P r,  P symmetric positive definite.  In row order; r [N s], s [m/s].
//   What it returns outside the range of S does not matter: the iteration filters it.
#pragma once

#include <memory>

#include "solver/linear/linear_solver.h"

namespace drape::internal {

class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  virtual std::string_view name() const = 0;
  // Made ready for this matrix and filter; says in the report's note what was not as usual. False: A is not
  // positive definite.
  virtual bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) = 0;
  virtual void apply(const VecX& r, VecX& s) = 0;
  // It did not act as a positive definite matrix: made safer, at the price of iterations. False: it cannot
  // be.
  virtual bool make_safer(const BlockMatrix& /*A*/, const Filter& /*filter*/, LinearReport& /*report*/) {
    return false;
  }
  // One that is kept over several systems says here that it no longer suits this one, after so many
  // iterations that made the residual smaller by so many powers of ten: it is made ready anew, and the
  // iteration goes on from where it is.
  virtual bool outdated(int /*iterations*/, double /*decades*/) const { return false; }
  virtual void learn(int /*iterations*/, double /*decades*/) {}  // what a whole solve took
  virtual void forget() {}  // what was kept is not to be used for another system
};

// The inverses of the 3x3 diagonal blocks.                                    [Baraff & Witkin 1998, 5.3]
std::unique_ptr<Preconditioner> make_block_jacobi();
// Incomplete Cholesky on the pattern's blocks, no fill.              [Meijerink & van der Vorst 1977]
std::unique_ptr<Preconditioner> make_block_ic0();
// Smoothed aggregation, a V-cycle.            [Vanek, Mandel & Brezina 1996; Tamstorf et al. 2015]
std::unique_ptr<Preconditioner> make_multigrid();

// "block-jacobi", "block-ic0", "multigrid"; null for any other name.
std::unique_ptr<Preconditioner> make_preconditioner(std::string_view name);

}  // namespace drape::internal
