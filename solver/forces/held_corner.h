// A triangle without area: its corners are on one line at rest, or at one place. It stores no strain, and
// without more the cloth would open there. Its middle corner is held where it is on the edge across from it.
//   E = k/2 |p|^2,   p = x_m - (1 - s) x_a - s x_b
// k [N/m] is the stiffness of the membrane, s where m stands on the edge from a to b at rest.
#pragma once

#include "solver/forces/stencil_force.h"

namespace drape::internal {

struct HeldCorner {
  static constexpr const char* name = "hold";
  static constexpr int particles = 3;  // m, a, b
  struct Rest {
    double s;
  };
  struct Common {
    double k;  // N/m
  };

  static std::array<double, 3> weights(const Rest& r) { return {1, r.s - 1, -r.s}; }
  static double energy(const Common& common, const Rest&, const Vec3& p) {
    return 0.5 * common.k * p.squaredNorm();
  }
  static double dissipation(const Common&, const Rest&, const Vec3&, const auto&) { return 0; }
  static Vec3 pull(const Common& common, const Rest&, const Vec3& p, const auto&) { return common.k * p; }
  static VectorResponse linearised(const Common& common, const Rest&, const Vec3& p, const auto&,
                                   const auto& shift, double c, Stiffness) {
    return {
        .impulse = c * common.k * (p + shift()), .block = c * c * common.k * Mat3::Identity(), .acts = true};
  }
};

}  // namespace drape::internal
