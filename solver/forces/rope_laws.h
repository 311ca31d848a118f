// The laws of a rope's segments and of its bends; solver/forces/rope.h has the equations.
#pragma once

#include <algorithm>

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
    double k;     // B / d [N m]
  };
  struct Common {};

  static std::array<double, 3> weights(const Rest& r) { return {1 / r.a, -1 / r.a - 1 / r.b, 1 / r.b}; }

  static double energy(const Common&, const Rest& r, const Vec3& p) { return 0.5 * r.k * p.squaredNorm(); }
  static double dissipation(const Common&, const Rest&, const Vec3&, const auto&) { return 0; }
  static Vec3 pull(const Common&, const Rest& r, const Vec3& p, const auto&) { return r.k * p; }
  static VectorResponse linearised(const Common&, const Rest& r, const Vec3& p, const auto&,
                                   const auto& shift, double c, Stiffness) {
    return {.impulse = c * r.k * (p + shift()), .block = c * c * r.k * Mat3::Identity(), .acts = true};
  }
};

struct RopeBendDamping {
  static constexpr const char* name = "bend damping";
  static constexpr int particles = 3;
  struct Rest {
    double a, b;   // m
    double c;      // C_b / d [N m s]
    double least;  // q_0
  };
  struct Common {};

  static double energy(const Common&, const Rest&, const Points<3>&) { return 0; }
  static Points<3> gradient(const Common&, const Rest&, const Points<3>&) { return Points<3>::Zero(); }
  static Blocks<3> hessian(const Common&, const Rest&, const Points<3>&, Stiffness) {
    return Blocks<3>::Zero();
  }
  static bool damped(const Common&) { return true; }
  static double square(double number) { return number * number; }
  // With Q = dq/dX: C_b / d (q_0^2 Q^T Q + Q^T q q^T Q) / (|q|^2 + q_0^2). Less where a segment is pressed to
  // less than half of its length: or D would grow without bounds, since what is short turns fast.
  static Blocks<3> damping(const Common&, const Rest& r, const Points<3>& X) {
    const Vec3 first = X.col(1) - X.col(0), second = X.col(2) - X.col(1);
    const double a = first.norm(), b = second.norm();
    if (a == 0 || b == 0) return Blocks<3>::Zero();
    const Vec3 t = first / a, u = second / b, q = u - t;
    const Mat3 of_first = (Mat3::Identity() - t * t.transpose()) / a;
    const Mat3 of_second = (Mat3::Identity() - u * u.transpose()) / b;
    Eigen::Matrix<double, 3, 9> Q;
    Q << of_first, -of_first - of_second, of_second;
    const Eigen::Matrix<double, 9, 1> along = Q.transpose() * q;
    const double small2 = r.least * r.least;
    Blocks<3> D = along * along.transpose();
    for (int k = 0; k < 9; ++k)
      for (int l = k; l < 9; ++l) D(k, l) = D(l, k) += small2 * Q.col(k).dot(Q.col(l));
    const double c = r.c * square(std::min(1.0, 2 * a / r.a)) * square(std::min(1.0, 2 * b / r.b));
    return c / (q.squaredNorm() + small2) * D;
  }
};

}  // namespace drape
