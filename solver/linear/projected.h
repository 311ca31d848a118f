// The filtered system as an ordinary sparse one, for solvers that have no filter.
//                                                                 [Tamstorf, Jones & McCormick 2015]
//   (S A S + I - S) y = S (b - A z),   dv = S y + z
// The lower triangle is stored column by column. Its pattern is kept while the serial of the matrix does not
// change; the values are refilled for every system.
#pragma once

#include <Eigen/SparseCore>

#include "solver/linear/linear_solver.h"

namespace drape {

class ProjectedSystem {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  void project(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options);

  const Matrix& matrix() const { return matrix_; }  // lower triangle of S A S + I - S
  const VecX& right_side() const { return right_; }
  double reference() const { return reference_; }  // the impulse that a residual is relative to [N s]

 private:
  void build_pattern(const BlockMatrix& A);

  Matrix matrix_;
  std::uint64_t serial_ = 0;
  std::vector<int> constrained_;  // row -> entry of the filter, -1: free
  VecX right_, z_;
  double reference_ = 0;
};

}  // namespace drape
