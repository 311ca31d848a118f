// Strips of cloth for tests against closed forms, with meshes of every kind: a strip lies in the plane y = 0
// and runs along x; its first two columns of vertices, at -h/2 and h/2, hold it, so that its clamp is at x =
// 0.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "mesh/obj/obj.h"
#include "mesh/pattern/pattern.h"
#include "mesh/triangles/generate.h"

namespace drape::test {

enum class StripMesh { square, diagonal, hexagonal, irregular };
inline constexpr std::array strip_meshes = {StripMesh::square, StripMesh::diagonal, StripMesh::hexagonal,
                                            StripMesh::irregular};
inline const char* name(StripMesh kind) {
  constexpr std::array names = {"squares along the strip", "squares at 45 degrees", "hexagons", "irregular"};
  return names[static_cast<std::size_t>(kind)];
}

struct Strip {
  TriangleMesh mesh;
  std::vector<int> clamped, tip;  // vertices
  double length;                  // m, from the clamp to the tip
};

// Triangles between two columns of vertices, the right one at larger x, both from low to high z.
inline void join(const std::vector<int>& left, const std::vector<int>& right, TriangleMesh& mesh) {
  const auto z = [&](int i) { return mesh.positions[static_cast<std::size_t>(i)].z(); };
  std::size_t l = 0, r = 0;
  while (l + 1 < left.size() || r + 1 < right.size()) {
    const bool right_next =
        l + 1 == left.size() || (r + 1 < right.size() && std::abs(z(right[r + 1]) - z(left[l])) <=
                                                             std::abs(z(left[l + 1]) - z(right[r])));
    if (right_next) {
      mesh.triangles.push_back({left[l], right[r + 1], right[r]});
      ++r;
    } else {
      mesh.triangles.push_back({left[l], left[l + 1], right[r]});
      ++l;
    }
  }
}

// About `cells` cells along the length [m], at least `across` of them across.
inline Strip strip(StripMesh kind, int cells, int across, double length) {
  double h = length / (cells - 0.5);
  Strip out{{}, {}, {}, length};
  switch (kind) {
    case StripMesh::square:
      out.mesh = grid(cells + 1, across + 1, h * cells, h * across);
      for (Vec3& x : out.mesh.positions) x.x() += 0.5 * h * (cells - 1);
      break;
    case StripMesh::hexagonal: {  // straight sides: every second column ends in two half edges
      const double width = h * across / std::sqrt(0.75), edge = width / across;
      std::vector<int> before;
      for (int i = 0; i <= cells; ++i) {
        std::vector<int> column;
        const auto add = [&](double z) {
          column.push_back(out.mesh.vertex_count());
          out.mesh.positions.push_back(Vec3((i - 0.5) * h, 0, z));
        };
        add(0);
        for (int j = 0; j + 1 < across + i % 2; ++j) add((j + 1 - 0.5 * (i % 2)) * edge);
        add(width);
        if (i > 0) join(before, column, out.mesh);
        before = column;
      }
      break;
    }
    case StripMesh::diagonal: {  // squares on a corner, cut by alternate diagonals; half squares at the sides
      // Two columns of corners make one square; its edge is that of the other meshes.
      const int columns = 2 * static_cast<int>(std::lround(cells / std::sqrt(2.0))) + 1,
                rows = 2 * static_cast<int>(std::lround(across / std::sqrt(2.0)));
      h = length / (columns - 1 - 0.5);
      std::map<std::pair<int, int>, int> at;
      const auto vertex = [&](int i, int j) {
        const auto [place, fresh] = at.try_emplace({i, j}, out.mesh.vertex_count());
        if (fresh) out.mesh.positions.push_back(Vec3((i - 0.5) * h, 0, (j - 0.5 * rows) * h));
        return place->second;
      };
      const auto inside = [&](int i, int j) { return i >= 0 && i < columns && j >= 0 && j <= rows; };
      for (int i = 0; i < columns; ++i)
        for (int j = 0; j <= rows; ++j) {
          if ((i + j) % 2 == 0) continue;
          const std::array<std::array<int, 2>, 4> corner = {{{i - 1, j}, {i, j + 1}, {i + 1, j}, {i, j - 1}}};
          std::vector<int> there;
          for (const auto& [p, q] : corner)
            if (inside(p, q)) there.push_back(vertex(p, q));
          auto& all = out.mesh.triangles;
          if (there.size() == 3) all.push_back({there[0], there[1], there[2]});
          if (there.size() < 4) continue;
          if ((i / 2 + j / 2 + i + j) % 2 == 0) {
            all.push_back({there[0], there[1], there[2]}), all.push_back({there[0], there[2], there[3]});
          } else {
            all.push_back({there[0], there[1], there[3]}), all.push_back({there[1], there[2], there[3]});
          }
        }
      break;
    }
    case StripMesh::irregular: {
      const double width = h * across;
      const auto at = [&](double x, double z) { return Eigen::Vector2d(x, z); };
      const auto line = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return line_segment(a, b);
      };
      const double left = 0.5 * h, right = length;
      Panel panel;
      panel.name = "strip";
      panel.outline.segments = {line(at(left, 0), at(right, 0)), line(at(right, 0), at(right, width)),
                                line(at(right, width), at(left, width)), line(at(left, width), at(left, 0))};
      panel.outline.names.resize(4);
      Pattern pattern;
      pattern.panels = {panel};
      out.mesh = triangulate(pattern, {.edge = 1.2 * h}).mesh;
      for (Vec3& x : out.mesh.positions) x = Vec3(x.x(), 0, x.y());
      // The first column, which is clamped, has a copy to its left.
      std::map<double, int> of_z;
      for (int i = 0; i < out.mesh.vertex_count(); ++i)
        if (const Vec3& x = out.mesh.positions[static_cast<std::size_t>(i)]; x.x() < left + 1e-9)
          of_z[x.z()] = i;
      std::vector<int> column, copy;
      for (const auto& [z, i] : of_z) {
        column.push_back(i);
        copy.push_back(out.mesh.vertex_count());
        out.mesh.positions.push_back(Vec3(-0.5 * h, 0, z));
      }
      join(copy, column, out.mesh);
      break;
    }
  }
  double last = -1e300;
  for (const Vec3& x : out.mesh.positions) last = std::max(last, x.x());
  out.length = last;
  for (int i = 0; i < out.mesh.vertex_count(); ++i) {
    const double x = out.mesh.positions[static_cast<std::size_t>(i)].x();
    if (x < 0.51 * h) out.clamped.push_back(i);
    if (x > last - 1e-9) out.tip.push_back(i);
  }
  return out;
}

}  // namespace drape::test
