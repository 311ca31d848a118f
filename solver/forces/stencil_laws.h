// What a law of 2, 3 or 4 particles is: solver/forces/stencil_force.h says what it gives.
#pragma once

#include "mesh/base/vectors.h"

namespace drape {

template <int n>
using Points = Eigen::Matrix<double, 3, n>;
template <int n>
using Blocks = Eigen::Matrix<double, 3 * n, 3 * n>;

// The impulse c (dE/dp + K s) + c D v [N s], with s the shift, and the block c D + c^2 K [kg], which is
// symmetric to the last bit.
struct VectorResponse {
  Vec3 impulse = Vec3::Zero();
  Mat3 block = Mat3::Zero();
  bool acts = false;  // false: both are zero
};

using Slopes = Eigen::Matrix<double, 3, 2>;
struct SlopeBlocks {
  Mat3 uu, uv, vv;  // uu and vv are symmetric
};

template <class Law>
concept VectorLaw = requires(const typename Law::Rest& rest) {
  Law::weights(rest);
};
template <class Law>
concept SlopeLaw = requires(const typename Law::Rest& rest) {
  Law::slope_weights(rest);
};

}  // namespace drape
