// Sheets of three kinds of triangles, for laws that have to hold on each.
#pragma once

#include <functional>
#include <random>

#include "mesh/triangles/generate.h"

namespace drape::test {

enum class Kind { squares, equilateral, irregular };
inline constexpr std::array kinds = {Kind::squares, Kind::equilateral, Kind::irregular};

// A sheet of n x n vertices about the origin, `size` [m] wide, bent to y = height(x, z).
inline TriangleMesh bent(int n, Kind kind, double size, const std::function<double(double, double)>& height) {
  TriangleMesh mesh =
      kind == Kind::equilateral ? equilateral_sheet(n, n, size / (n - 1)) : grid(n, n, size, size);
  std::mt19937 random(static_cast<unsigned>(n));
  std::uniform_real_distribution<double> off(-0.25 * size / (n - 1), 0.25 * size / (n - 1));
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : mesh.positions) middle += x / mesh.vertex_count();
  for (Vec3& x : mesh.positions) {
    x -= middle;
    if (kind == Kind::irregular) x += Vec3(off(random), 0, off(random));
    x[1] = height(x[0], x[2]);
  }
  return mesh;
}

}  // namespace drape::test
