// Smoothed aggregation over whole vertices.             [Vanek, Mandel & Brezina 1996, sections 3 and 4]
//   i and j are strongly coupled when |A_ij|_F^2 > theta^2 |A_ii|_F |A_jj|_F. An aggregate is a vertex and
//   its strong neighbours. The tentative prolongation T gives each aggregate one translation (a 3x3 block S_i
//   for every vertex). P = (I - omega D_F^-1 A_F) T, where A_F is A with its weak couplings moved to the
//   diagonal.
// The coarse unknowns are translations alone: rotations as further unknowns made the solver slower on cloth.
#pragma once

#include "solver/linear/projected_block.h"
#include "solver/linear/smoother.h"

namespace drape::internal {

class Aggregation {
 public:
  // Makes P and returns how many columns it has. projected: has the S_i; null: all of them are the identity.
  int make_prolongation(const Smoother& A, double theta, const ProjectedBlocks* projected, BlockRows& P);

 private:
  void find_strong(const Smoother& A, double theta, const ProjectedBlocks* projected);
  int aggregate();

  SparseRows<1> strong_;         // the strong neighbours of every vertex, and how strongly they are coupled
  std::vector<float> least_;     // theta |A_ii|
  std::vector<int> of_, begun_;  // vertex -> aggregate, in the end and before the aggregates grew
};

}  // namespace drape::internal
