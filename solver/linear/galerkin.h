// The matrix of the next coarser level, A_c = P^T A P, and the parts it is made of.       [Gustavson 1978]
//   Only the upper triangle of the symmetric A_c is computed, and of each diagonal block only the lower half:
//   so A_c is symmetric to the last bit.
#pragma once

#include "solver/linear/mirror.h"
#include "solver/linear/smoother.h"
#include "solver/linear/sparse_rows.h"

namespace drape::internal {

// A symmetric matrix, stored as its upper triangle with the diagonal block first in each row; each() goes
// through whole rows.
class SymmetricRows {
 public:
  int rows() const { return upper_.rows(); }
  int bandwidth() const { return bandwidth_; }

  // Calls f(column, block, turned). Where `turned` the entry of the matrix is the transpose of the block.
  template <class F>
  void each(int row, const F& f) const {
    below_.in_column(row, [&](int c, int k) { f(c, upper_[c][k], true); });
    const BlockRows::Row blocks = upper_[row];
    for (int k = 0; k < blocks.count; ++k) f(blocks.column[k], blocks[k], false);
  }

 private:
  friend class Galerkin;

  BlockRows upper_;
  Mirror below_;
  int bandwidth_ = 0;
};

// R = P^T
void transpose(const BlockRows& P, int columns, BlockRows& R);

class Galerkin {
 public:
  // R = P^T. A direction in which no vertex of an aggregate may move has no stiffness, and nothing pushes
  // along it. So that the matrix can be inverted there, every diagonal block gets a small addition: 2e-7 of
  // its trace in each direction (1 kg where there is no trace).
  const SymmetricRows& coarse(const Smoother& A, const BlockRows& P, const BlockRows& R);

 private:
  BlockRows product_;  // A P
  SymmetricRows coarse_;
};

}  // namespace drape::internal
