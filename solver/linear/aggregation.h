// Smoothed aggregation over whole vertices.                    [Vanek, Mandel & Brezina 1996, sections 3 and
// 4]
//   i and j are strongly coupled when |A_ij|_F^2 > theta^2 |A_ii|_F |A_jj|_F; aggregates are a vertex and its
//   strong neighbours; the tentative prolongation T gives each aggregate one translation (a 3x3 block S_i for
//   every vertex); P = (I - omega D_F^-1 A_F) T, A_F with its weak couplings moved to the diagonal.
// Translations alone: rotations as further coarse unknowns made it slower on cloth.
#pragma once

#include <functional>

#include "solver/linear/block_csr.h"

namespace drape {

// A: symmetric, both halves. tentative(i): the block of vertex i; zero: it has no part in the coarse problem.
BlockCsr smoothed_aggregation(const BlockCsr& A, double theta, const std::function<Mat3(int)>& tentative);

}  // namespace drape
