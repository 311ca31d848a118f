// The matrix of the next coarser level, A_c = P^T A P, and what it is made of.       [Gustavson 1978]
//   Of the symmetric A_c only the upper triangle is computed, and of a block on the diagonal its lower half
//   alone counts: so it is symmetric to the last bit.
#pragma once

#include "solver/linear/mirror.h"
#include "solver/linear/smoother.h"
#include "solver/linear/sparse_rows.h"

namespace drape::internal {

// The upper triangle of a symmetric matrix, each row's diagonal block first; gone through whole, row by row.
class SymmetricRows {
 public:
  int rows() const { return upper_.rows(); }
  int bandwidth() const { return bandwidth_; }

  template <class F>  // f(column, block)
  void each(int row, const F& f) const {
    below_.in_column(row, [&](int c, int k) { f(c, block(c, k).transpose()); });
    for (int k = 0; k < upper_[row].count; ++k) f(upper_[row].column[k], block(row, k));
  }

 private:
  friend class Galerkin;
  Eigen::Map<const Eigen::Matrix3f> block(int row, int k) const {
    return Eigen::Map<const Eigen::Matrix3f>(upper_[row][k]);
  }

  BlockRows upper_;
  Mirror below_;
  int bandwidth_ = 0;
};

// R = P^T
void transpose(const BlockRows& P, int columns, BlockRows& R);

class Galerkin {
 public:
  // R = P^T. A direction that no vertex of an aggregate may take has no stiffness, and nothing pushes along
  // it: so that it can be divided by, every diagonal block gets a little, 2e-7 of its trace in each direction
  // (1 kg where there is no trace).
  const SymmetricRows& coarse(const Smoother& A, const BlockRows& P, const BlockRows& R);

 private:
  BlockRows product_;  // A P
  SymmetricRows coarse_;
};

}  // namespace drape::internal
