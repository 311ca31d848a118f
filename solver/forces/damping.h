// Internal damping between two particles; neither kind slows a free fall.
//   relative  f_i = -k_d (v_i - v_j),             D = k_d I       [Noh & Jung, eq. 14]
//   axial     f_i = -k_d ((v_i - v_j) . n) n,     D = k_d n n^T   along the connection only
// k_d [N s/m]. Axial damping is zero between coincident particles.
#pragma once

#include "solver/forces/stencil_force.h"

namespace drape {

struct Damper {
  static constexpr const char* name = "damping";
  static constexpr int particles = 2;
  struct Rest {};
  struct Common {
    double k_d;  // N s/m
    DampingKind kind;
  };

  static constexpr std::array<double, 2> weights(const Rest&) { return {1, -1}; }

  static Mat3 coefficient(const Common& damper, const Vec3& d) {
    if (damper.kind == DampingKind::relative) return damper.k_d * Mat3::Identity();
    const double l2 = d.squaredNorm();
    return l2 == 0 ? Mat3::Zero() : Mat3((damper.k_d / l2 * d) * d.transpose());
  }
  static double energy(const Common&, const Rest&, const Vec3&) { return 0; }
  static double dissipation(const Common& damper, const Rest&, const Vec3& d, const auto& velocity) {
    const Vec3 v = velocity();
    return 0.5 * v.dot(coefficient(damper, d) * v);
  }
  static Vec3 pull(const Common& damper, const Rest&, const Vec3& d, const auto& velocity) {
    return coefficient(damper, d) * velocity();
  }
  static Vec3 alone(const Common& damper, const Rest&, const Vec3& p, const Vec3& free, double W, double h,
                    const auto& velocity) {
    const Vec3 v_free = velocity() - (p - free) / h;
    const double l2 = p.squaredNorm(), factor = -h * damper.k_d / (1 + W * h * damper.k_d);
    if (damper.kind == DampingKind::relative) return factor * v_free;
    return l2 == 0 ? Vec3(Vec3::Zero()) : Vec3(factor * p.dot(v_free) / l2 * p);
  }
  static VectorResponse linearised(const Common& damper, const Rest&, const Vec3& d, const auto& velocity,
                                   const auto&, double c, Stiffness) {
    const Mat3 cD = c * coefficient(damper, d);
    return {.impulse = cD * velocity(), .block = cD, .acts = true};
  }
};

class PairDamping final : public StencilForce<Damper> {
 public:
  PairDamping(std::vector<Element> elements, double k_d, DampingKind kind)
      : StencilForce(std::move(elements), {k_d, kind}) {}
};

}  // namespace drape
