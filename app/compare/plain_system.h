// A recorded linear system in particle order, number by number, as other programs take it.
//   with the constraints beside it    S (A dv - b) = 0,  (I - S) dv = z
//   with the constraints inside       (S A S + I - S) y = S (b - A z),  dv = S y + z
// A [kg], b [N s], dv, y, z [m/s]; S has no unit. Row 3 i + k is coordinate k of particle i. Every matrix is
// symmetric and stored with both its triangles, so that its compressed columns are also its compressed rows.
#pragma once

#include <Eigen/SparseCore>

#include "app/compare/recording_solver.h"

namespace drape::app {

using PlainMatrix = Eigen::SparseMatrix<double>;

struct PlainSystem {
  PlainMatrix matrix;
  VecX right;  // N s
};
PlainSystem plain_system(const LinearSystem& system);      // A and b
PlainSystem projected_system(const LinearSystem& system);  // S A S + I - S and S (b - A z)

struct PlainFilter {
  std::vector<Mat3> S;  // of every particle: the identity where it is free
  VecX z;               // m/s
};
PlainFilter plain_filter(const LinearSystem& system);

// The solution dv = S y + z that belongs to a solution y of the projected system, both in particle order.
VecX solution_within_constraints(const LinearSystem& system, const VecX& y);

}  // namespace drape::app
