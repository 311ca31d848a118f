// Forces that a user writes: three particles that keep the area of their triangle, and four particles whose
// stencils are found anew in every step, a point that is kept off a triangle.
#pragma once

#include <drape/drape.h>

#include <cmath>
#include <vector>

// E = k/2 (A - A_0)^2, A [m^2] the area, k [N/m^3].  dA/dx_i = n x e_i / 2, e_i the edge across from x_i.
// The part of the Hessian that is always positive semidefinite: k grad A grad A^T.
struct AreaLaw {
  static constexpr const char* name = "area";
  static constexpr int particles = 3;
  struct Rest {
    double area;  // m^2
    double k;     // N/m^3
  };
  struct Common {};
  using X = drape::Points<3>;

  static drape::Vec3 doubled(const X& x) {
    return drape::Vec3(x.col(1) - x.col(0)).cross(drape::Vec3(x.col(2) - x.col(0)));
  }
  static double energy(const Common&, const Rest& r, const X& x) {
    const double off = 0.5 * doubled(x).norm() - r.area;
    return 0.5 * r.k * off * off;
  }
  static X slope(const X& x) {  // of the area
    const drape::Vec3 n = doubled(x).stableNormalized();
    X slope;
    for (int i = 0; i < 3; ++i)
      slope.col(i) = 0.5 * n.cross(drape::Vec3(x.col((i + 2) % 3) - x.col((i + 1) % 3)));
    return slope;
  }
  static X gradient(const Common&, const Rest& r, const X& x) {
    return r.k * (0.5 * doubled(x).norm() - r.area) * slope(x);
  }
  static drape::Blocks<3> hessian(const Common&, const Rest& r, const X& x, drape::Stiffness) {
    const X g = slope(x);
    const Eigen::Map<const Eigen::Matrix<double, 9, 1>> flat(g.data());
    return r.k * flat * flat.transpose();
  }
};

// A point on a spring away from the inside of a triangle: p = x_0 - (b_1 x_1 + b_2 x_2 + b_3 x_3),
//   g = n . p - d,  E = k/2 min(g, 0)^2.   n, b: of the step.
struct PointTriangleLaw {
  static constexpr const char* name = "point-triangle";
  static constexpr int particles = 4;
  struct Rest {
    std::array<double, 3> b;
    drape::Vec3 normal;
    double distance;  // m
    double k;         // N/m
  };
  struct Common {};

  static std::array<double, 4> weights(const Rest& r) { return {1, -r.b[0], -r.b[1], -r.b[2]}; }
  static double gap(const Rest& r, const drape::Vec3& p) {
    return std::fmin(r.normal.dot(p) - r.distance, 0.0);
  }
  static double energy(const Common&, const Rest& r, const drape::Vec3& p) {
    return 0.5 * r.k * gap(r, p) * gap(r, p);
  }
  static double dissipation(const Common&, const Rest&, const drape::Vec3&, const auto&) { return 0; }
  static drape::Vec3 pull(const Common&, const Rest& r, const drape::Vec3& p, const auto&) {
    return r.k * gap(r, p) * r.normal;
  }
  static drape::VectorResponse linearised(const Common&, const Rest& r, const drape::Vec3& p, const auto&,
                                          const auto& shift, double c, drape::Stiffness) {
    if (gap(r, p) == 0) return {};
    return {.impulse = c * r.k * (gap(r, p) + r.normal.dot(shift())) * r.normal,
            .block = c * c * r.k * r.normal * r.normal.transpose(),
            .acts = true};
  }
};

using PointTriangleForce = drape::StencilForce<PointTriangleLaw>;

// Every particle below `height` [m] is kept off the triangle (0, 1, 2), along y.
inline PointTriangleForce::Finder low_particles(double height) {
  return [height](const drape::StepStart& start, std::vector<PointTriangleForce::Element>& found) {
    found.clear();
    for (int i = 3; i < static_cast<int>(start.x.size() / 3); ++i)
      if (start.x[3 * i + 1] < height)
        found.push_back(
            {.particles = {i, 0, 1, 2}, .rest = {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0, 1, 0}, 0.05, 40}});
    return true;
  };
}
