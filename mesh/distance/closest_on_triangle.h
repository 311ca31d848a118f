// The point of a triangle nearest to x, and the feature (vertex, edge or face) that holds it.
//   [Ericson 2005, Real-time collision detection, 5.1.5]
// For a triangle without an area the feature is a vertex or an edge.
#pragma once

#include <Eigen/Geometry>
#include <utility>

#include "mesh/base/vectors.h"
#include "mesh/triangles/normals.h"

namespace drape {

enum Feature : int { at_vertex = 0, on_edge = 3, on_face = 6 };  // vertex k: k, edge k to k + 1: 3 + k

inline int next(int k) { return k == 2 ? 0 : k + 1; }

inline std::pair<Vec3, int> closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ax = x - a;
  const double ab_a = ab.dot(ax), ac_a = ac.dot(ax);
  if (ab_a <= 0 && ac_a <= 0) return {a, at_vertex};
  const Vec3 bx = x - b;
  const double ab_b = ab.dot(bx), ac_b = ac.dot(bx);
  if (ab_b >= 0 && ac_b <= ab_b) return {b, at_vertex + 1};
  const Vec3 cx = x - c;
  const double ab_c = ab.dot(cx), ac_c = ac.dot(cx);
  if (ac_c >= 0 && ab_c <= ac_c) return {c, at_vertex + 2};
  // The areas beside the edges are taken as cross products: differences of products of the dot products would
  // lose the digits of a sliver.
  const Vec3 n = ab.cross(ac);
  const double beside_ab = n.dot(ab.cross(ax));
  if (beside_ab <= 0 && ab_a >= 0 && ab_b <= 0) return {a + ab_a / (ab_a - ab_b) * ab, on_edge};
  const double beside_ca = n.dot(ax.cross(ac));
  if (beside_ca <= 0 && ac_a >= 0 && ac_c <= 0) return {a + ac_a / (ac_a - ac_c) * ac, on_edge + 2};
  const double along_b = ac_b - ab_b, along_c = ab_c - ac_c;
  const Vec3 bc = c - b;
  if (n.dot(bc.cross(bx)) <= 0 && along_b >= 0 && along_c >= 0)
    return {b + along_b / (along_b + along_c) * bc, on_edge + 1};
  const double scale = 1 / n.squaredNorm();
  return {a + beside_ca * scale * ab + beside_ab * scale * ac, on_face};
}

// The barycentric weights of the closest point of a triangle, given the feature that holds this point.
inline Vec3 weights_on_triangle(const Vec3& point, int feature, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (feature < on_edge) return Vec3::Unit(feature);
  if (feature == on_face) {
    const Vec3 n = twice_area_normal(a, b, c), p = point - a;
    const double area = n.squaredNorm(), v = n.dot(p.cross(c - a)) / area, w = n.dot((b - a).cross(p)) / area;
    return {1 - v - w, v, w};
  }
  const Vec3* const corners[] = {&a, &b, &c};
  const int from = feature - on_edge, to = next(from);
  const Vec3 side = *corners[to] - *corners[from];
  const double t = side.dot(point - *corners[from]) / side.squaredNorm();
  return (1 - t) * Vec3::Unit(from) + t * Vec3::Unit(to);
}

}  // namespace drape
