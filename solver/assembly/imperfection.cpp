#include "solver/assembly/imperfection.h"

#include <array>
#include <cmath>
#include <numbers>

#include "mesh/triangles/extent.h"
#include "mesh/triangles/normals.h"

namespace drape {
namespace {

struct Wave {
  Vec3 direction;  // on the diagonal of the rest shape's box: how many waves along x, y and z
  double phase;    // rad
};

double waves_at(const Vec3& q) {
  static const std::array<Wave, 4> waves = {{{{0.43, 0.31, 0.46}, 0.4},
                                             {{-0.97, 0.85, 0.61}, 1.9},
                                             {{1.21, -1.73, 1.57}, 3.3},
                                             {{2.83, 2.39, -3.49}, 5.2}}};
  double sum = 0;
  for (const Wave& wave : waves)
    sum += std::sin(2 * std::numbers::pi * wave.direction.dot(q) + wave.phase) / waves.size();
  return sum;
}

}  // namespace

std::vector<Vec3> imperfection(const TriangleMesh& mesh, const TriangleMesh& rest, double amplitude) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<Vec3> at(mesh.positions.size(), Vec3::Zero());
  const Eigen::AlignedBox3d box = box_of(rest.positions, rest.triangles);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) at[mesh.triangles[t][k]] = rest.positions[rest.triangles[t][k]];
  std::vector<Vec3> moved(mesh.positions.size(), Vec3::Zero());
  const double L = box.isEmpty() ? 0 : box.diagonal().norm();
  if (!(L > 0) || amplitude == 0) return moved;
  for (std::size_t v = 0; v < moved.size(); ++v)
    moved[v] = amplitude * waves_at((at[v] - box.min()) / L) * normals[v];
  return moved;
}

}  // namespace drape
