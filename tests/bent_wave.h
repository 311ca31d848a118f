// The bending energy of a sheet of 0.4 m that is bent into a wave which fades out before the border, against
// that of the wave's curvature.
#pragma once

#include <algorithm>
#include <cmath>

#include "mesh/base/vectors.h"
#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/force.h"
#include "solver/forces/plate.h"
#include "tests/strips.h"

namespace drape::test {

inline constexpr double wave_sheet_size = 0.4;  // m

// A square of `cells` cells along each side, in the plane y = 0.
inline TriangleMesh wave_sheet(StripMesh kind, int cells) {
  return strip(kind, cells, cells, wave_sheet_size).mesh;
}

// How much larger the energy of `bending` is than that of the curvature of the wave, by its exact second
// derivatives and the stiffness `D`: 0.01 is 1 % too stiff. The wave runs along `angle` [rad] from x to z,
// `length` [m] from crest to crest, and is a millimetre high. `warp` is a unit vector in the plane of the
// sheet.
inline double wave_energy_error(const TriangleMesh& mesh, const Force& bending, const PlateStiffness& D,
                                const Vec3& warp, double angle, double length) {
  constexpr double L = wave_sheet_size;
  const double k = 2 * M_PI / length;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : mesh.positions) middle += x / mesh.vertex_count();
  // Zero from 0.45 L on, nine tenths of the way from the middle to the border, without a kink.
  const auto fade = [&](double a) {
    return std::pow(std::cos(M_PI * std::clamp(1.1 * a / L, -0.5, 0.5)), 4);
  };
  const auto height = [&](double a, double b) {
    const double p = a - middle.x(), q = b - middle.z();
    return 1e-3 * std::sin(k * (std::cos(angle) * p + std::sin(angle) * q)) * fade(p) * fade(q);
  };
  double expected = 0;
  const double d = L / 200, step = 1e-4;
  for (double a = middle.x() - L / 2 + d / 2; a < middle.x() + L / 2; a += d)
    for (double b = middle.z() - L / 2 + d / 2; b < middle.z() + L / 2; b += d) {
      const auto second = [&](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
        const auto w = [&](double s, double t) {
          const Eigen::Vector2d at = Eigen::Vector2d(a, b) + step * (s * u + t * v);
          return height(at[0], at[1]);
        };
        return (w(1, 1) - w(1, -1) - w(-1, 1) + w(-1, -1)) / (4 * step * step);
      };
      const Eigen::Vector2d u(warp.x(), warp.z()), v(-warp.z(), warp.x());
      const double uu = second(u, u), vv = second(v, v), uv = second(u, v);
      expected +=
          0.5 * d * d * (D.warp * uu * uu + D.weft * vv * vv + 2 * D.cross * uu * vv + 4 * D.twist * uv * uv);
    }
  VecX x(3 * mesh.vertex_count());
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3& p = mesh.positions[static_cast<std::size_t>(i)];
    x.segment<3>(3 * i) = Vec3(p.x(), height(p.x(), p.z()), p.z());
  }
  return bending.energy(x) / expected - 1;
}

}  // namespace drape::test
