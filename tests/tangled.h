// Meshes with every kind of edge and vertex that is no surface.
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::test {

inline TriangleMesh mesh_of(int vertices, std::vector<Triangle> triangles) {
  TriangleMesh mesh;
  for (int i = 0; i < vertices; ++i) mesh.positions.push_back({std::cos(i), std::sin(i), i * 0.1});
  mesh.triangles = std::move(triangles);
  return mesh;
}

// Random triangles over few vertices: every kind of non-manifold there is, with equal triangles.
inline TriangleMesh tangle(int vertices, int triangles, unsigned seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh = mesh_of(vertices, {});
  const auto any = [&] { return static_cast<int>(random() % static_cast<unsigned>(vertices)); };
  for (int i = 0; i < triangles; ++i) mesh.triangles.push_back({any(), any(), any()});
  return mesh;
}

}  // namespace drape::test
