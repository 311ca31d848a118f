// The edges of one triangle that pass through another one, as exact as the coordinates are given.
//   An edge passes through a triangle when its ends lie strictly on both sides of the plane, and it meets the
//   triangle, border included. Triangles that only touch do not cross, nor do those that have a vertex in
//   common.
#pragma once

#include <algorithm>
#include <array>

#include "mesh/base/predicates.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape::internal {

inline bool share_a_vertex(const Triangle& s, const Triangle& t) {
  return std::any_of(s.begin(), s.end(), [&](int v) { return std::find(t.begin(), t.end(), v) != t.end(); });
}

inline bool boxes_touch(const std::vector<Vec3>& x, const Triangle& s, const Triangle& t) {
  for (int k = 0; k < 3; ++k) {
    const auto [s_low, s_high] = std::minmax({x[s[0]][k], x[s[1]][k], x[s[2]][k]});
    const auto [t_low, t_high] = std::minmax({x[t[0]][k], x[t[1]][k], x[t[2]][k]});
    if (s_high < t_low || t_high < s_low) return false;
  }
  return true;
}

// Calls found(a, b), a < b, for every edge of s that passes through t. Returns whether s is on one side of
// the plane of t: then no edge of t passes through s, either.
template <class Found>
bool passing_edges(const std::vector<Vec3>& x, const Triangle& s, const Triangle& t, const Found& found) {
  std::array<int, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = orient3d(x[t[0]], x[t[1]], x[t[2]], x[s[k]]);
  if (side[0] != 0 && side[0] == side[1] && side[0] == side[2]) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (side[k] * side[(k + 1) % 3] >= 0) continue;
    const int a = std::min(s[k], s[(k + 1) % 3]), b = std::max(s[k], s[(k + 1) % 3]);
    bool left = false, right = false;  // of the edge there is a side of the triangle
    for (std::size_t e = 0; e < 3; ++e) {
      const int turn = orient3d(x[a], x[b], x[t[e]], x[t[(e + 1) % 3]]);
      left = left || turn > 0;
      right = right || turn < 0;
    }
    if (left != right) found(a, b);
  }
  return false;
}

// Where the edge from a to b meets the plane of the triangle, as a share of the way from a.
inline double share_of_way(const std::vector<Vec3>& x, int a, int b, const Triangle& t) {
  const Vec3 normal = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  const double from = normal.dot(x[a] - x[t[0]]), to = normal.dot(x[b] - x[t[0]]);
  return from == to ? 0.5 : std::clamp(from / (from - to), 0.0, 1.0);
}

}  // namespace drape::internal
