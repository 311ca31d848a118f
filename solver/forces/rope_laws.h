// The laws of a rope's segments and of its bends; solver/forces/rope.h has the equations.
#pragma once

#include "solver/forces/linear_spring.h"

namespace drape {

struct RopeStretch : LinearSpring {
  static constexpr const char* name = "stretch";
  static double damper(double C_s, const Rest& r) { return C_s / r.L; }  // N s/m
};

struct RopeBend {
  static constexpr const char* name = "bend";
  static constexpr int particles = 3;
  struct Rest {
    double a, b;  // m
    double k, c;  // B / d [N m], C_b / d [N m s]
  };
  struct Common {};

  static std::array<double, 3> weights(const Rest& r) { return {1 / r.a, -1 / r.a - 1 / r.b, 1 / r.b}; }

  static double energy(const Common&, const Rest& r, const Vec3& p) { return 0.5 * r.k * p.squaredNorm(); }
  static double dissipation(const Common&, const Rest& r, const Vec3& p, const auto& velocity) {
    const double rate = r.c == 0 ? 0 : direction(p).dot(velocity());
    return 0.5 * r.c * rate * rate;
  }
  static Vec3 pull(const Common&, const Rest& r, const Vec3& p, const auto& velocity) {
    if (r.c == 0) return r.k * p;
    const Vec3 n = direction(p);
    return r.k * p + r.c * n.dot(velocity()) * n;
  }
  static VectorResponse linearised(const Common&, const Rest& r, const Vec3& p, const auto& velocity,
                                   const auto& shift, double c, Stiffness) {
    VectorResponse response{.acts = true};
    response.impulse = c * r.k * (p + shift());
    response.block = c * c * r.k * Mat3::Identity();
    if (r.c == 0) return response;
    const Vec3 n = direction(p);
    response.impulse += c * r.c * n.dot(velocity()) * n;
    response.block += c * r.c * (n * n.transpose());
    return response;
  }

 private:
  static Vec3 direction(const Vec3& p) {
    const double size = p.norm();
    return size == 0 ? Vec3::Zero() : Vec3(p / size);
  }
};

}  // namespace drape
