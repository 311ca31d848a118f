// Smoothed aggregation over whole vertices.             [Vanek, Mandel & Brezina 1996, sections 3 and 4]
//   i and j are strongly coupled when |A_ij|_F^2 > theta^2 |A_ii|_F |A_jj|_F; aggregates are a vertex and its
//   strong neighbours; the tentative prolongation T gives each aggregate one translation (a 3x3 block S_i for
//   every vertex); P = (I - omega D_F^-1 A_F) T, A_F with its weak couplings moved to the diagonal.
// Translations alone: rotations as further coarse unknowns made it slower on cloth.
#pragma once

#include "solver/linear/projected_block.h"
#include "solver/linear/smoother.h"

namespace drape::internal {

// Makes P and returns how many columns it has. projected: gives the S_i; null: all of them the identity.
int smoothed_aggregation(const Smoother& A, double theta, const ProjectedBlocks* projected, BlockRows& P);

}  // namespace drape::internal
