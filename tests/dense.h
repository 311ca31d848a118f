// A matrix of blocks as a dense one, in the order of the particles.
#pragma once

#include "solver/matrix/block_matrix.h"

namespace drape::test {

inline Eigen::MatrixXd dense(const BlockMatrix& A) {
  const Eigen::Index n = 3 * A.rows();
  Eigen::MatrixXd D(n, n);
  VecX rows(n), product(n), column(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    to_rows(A.pattern(), VecX(VecX::Unit(n, k)), rows);
    A.multiply(rows, product);
    to_particles(A.pattern(), product, column);
    D.col(k) = column;
  }
  return D;
}

}  // namespace drape::test
