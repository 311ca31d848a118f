#include "solver/assembly/imperfection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

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

// Calls f(vertices) for every place, with the vertices that are at exactly this place, ascending.
template <class F>
void for_places(const std::vector<Vec3>& positions, const F& f) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](int v) { return std::array{positions[v][0], positions[v][1], positions[v][2]}; };
  std::ranges::stable_sort(order, {}, place);
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin, order.end(), [&](int v) { return place(v) != place(*begin); });
    f(std::span<const int>(begin, end));
    begin = end;
  }
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
  for_places(mesh.positions, [&](std::span<const int> here) {
    Vec3 normal = Vec3::Zero();
    for (const int v : here) normal += normals[v];
    if (normal.norm() < 1e-6) return;  // they look opposite ways
    if (here.size() > 1) normal.normalize();
    const Vec3 way = amplitude * waves_at((at[here[0]] - box.min()) / L) * normal;
    for (const int v : here) moved[v] = way;
  });
  return moved;
}

}  // namespace drape
