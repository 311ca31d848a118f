// One pair of particles of a plate (solver/forces/plate.h): E = k/2 |x_i - x_j|^2. The constant k [N/m] is
// negative for some pairs; the sum over all pairs of a plate is positive semidefinite.
// The viscosity of bending is D = T K, with a time T [s].
#pragma once

#include "solver/forces/stencil_force.h"

namespace drape {

struct PlateLaw {
  static constexpr const char* name = "bend";
  static constexpr int particles = 2;
  struct Rest {
    double k;  // N/m
  };
  using Common = double;  // T [s]

  static constexpr std::array<double, 2> weights(const Rest&) { return {1, -1}; }
  static double energy(double, const Rest& r, const Vec3& d) { return 0.5 * r.k * d.squaredNorm(); }
  static double dissipation(double time, const Rest& r, const Vec3&, const auto& velocity) {
    return time == 0 ? 0 : 0.5 * time * r.k * velocity().squaredNorm();
  }
  static Vec3 pull(double time, const Rest& r, const Vec3& d, const auto& velocity) {
    return time == 0 ? Vec3(r.k * d) : Vec3(r.k * (d + time * velocity()));
  }
  static VectorResponse linearised(double time, const Rest& r, const Vec3& d, const auto& velocity,
                                   const auto& shift, double c, Stiffness) {
    VectorResponse response{.acts = true};
    response.impulse = c * r.k * (d + shift());
    if (time > 0) response.impulse += c * r.k * time * velocity();
    response.block = c * r.k * (c + time) * Mat3::Identity();
    return response;
  }
};

}  // namespace drape
