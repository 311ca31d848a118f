// An approximate inverse P of the projected matrix S A S + I - S, for the conjugate gradient.
//   s = P r,  P symmetric positive definite.  Vectors are in row order; r [N s], s [m/s].
//   What P returns outside the range of S does not matter, because the iteration filters it.
#pragma once

#include <memory>

#include "solver/linear/linear_solver.h"

namespace drape::internal {

class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  virtual std::string_view name() const = 0;
  // Makes it ready for this matrix and filter; the report's shift or note says what was unusual. False: A is
  // not positive definite.
  virtual bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) = 0;
  virtual void apply(const VecX& r, VecX& s) = 0;
  // The same, and Bs = B s where that comes for less than a product: B is the base of the projected matrix,
  // without its overlay, off by what float loses. False: Bs was not written.
  virtual bool apply_and_multiply(const VecX& r, VecX& s, VecX& /*Bs*/) {
    apply(r, s);
    return false;
  }
  // Called when it did not act as a positive definite matrix: makes it safer, at the price of more
  // iterations. False: it cannot be made safer.
  virtual bool make_safer(const BlockMatrix& /*A*/, const Filter& /*filter*/, LinearReport& /*report*/) {
    return false;
  }
  // A preconditioner that is kept over several systems returns true here when it no longer suits this one,
  // after this many iterations that made the residual smaller by this many powers of ten. It is then made
  // ready anew, and the iteration goes on from where it is.
  virtual bool outdated(int /*iterations*/, double /*decades*/) const { return false; }
  virtual void learn(int /*iterations*/, double /*decades*/) {}  // is told what a whole solve took
  virtual void forget() {}  // what was kept must not be used for another system
};

// The inverses of the 3x3 diagonal blocks.                                    [Baraff & Witkin 1998, 5.3]
std::unique_ptr<Preconditioner> make_block_jacobi();
// Incomplete Cholesky on the blocks of base and overlay, without fill.        [Meijerink & van der Vorst 1977]
std::unique_ptr<Preconditioner> make_block_ic0();
// A V-cycle of smoothed aggregation.            [Vanek, Mandel & Brezina 1996; Tamstorf et al. 2015]
std::unique_ptr<Preconditioner> make_multigrid();

// Makes "block-jacobi", "block-ic0" or "multigrid"; returns null for any other name.
std::unique_ptr<Preconditioner> make_preconditioner(std::string_view name);

}  // namespace drape::internal
