#include "app/picture/normals.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mesh/triangles/normals.h"
#include "mesh/triangles/topology.h"

namespace drape::app::drawing {
namespace {

constexpr int crowd = 1000;  // faces round a vertex

}  // namespace

std::vector<CornerNormals> corner_normals(const std::vector<Vec3>& positions,
                                          const std::vector<Triangle>& triangles, double crease_degrees) {
  const std::vector<int> vertex = welded(positions);
  const std::size_t n = triangles.size();
  std::vector<Vec3> face(n);
  std::vector<std::array<double, 3>> weight(n);
  std::vector<int> start(positions.size() + 1, 0);
  for (std::size_t t = 0; t < n; ++t) {
    const auto corner = [&](std::size_t k) -> const Vec3& { return positions[triangles[t][k % 3]]; };
    face[t] = twice_area_normal(corner(0), corner(1), corner(2)).stableNormalized();
    for (std::size_t k = 0; k < 3; ++k) {
      weight[t][k] = angle_between(corner(k + 1) - corner(k), corner(k + 2) - corner(k));
      ++start[vertex[triangles[t][k]] + 1];
    }
  }
  for (std::size_t v = 0; v < positions.size(); ++v) start[v + 1] += start[v];
  std::vector<std::array<int, 2>> round(3 * n);  // triangle and corner, by vertex
  std::vector<int> at = start;
  for (std::size_t t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k) round[at[vertex[triangles[t][k]]]++] = {static_cast<int>(t), k};

  const double least = std::cos(crease_degrees * std::numbers::pi / 180);
  std::vector<CornerNormals> normals(n);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = vertex[triangles[t][k]];
      Vec3 sum = Vec3::Zero();
      if (start[v + 1] - start[v] > crowd) {  // the hub of a wheel: each with each would take too long
        normals[t][k] = face[t].cast<float>();
        continue;
      }
      for (int i = start[v]; i < start[v + 1]; ++i) {
        const auto [other, corner] = round[i];
        if (other == static_cast<int>(t) || face[other].dot(face[t]) > least)
          sum += weight[other][corner] * face[other];
      }
      normals[t][k] = sum.stableNormalized().cast<float>();
    }
  return normals;
}

}  // namespace drape::app::drawing
