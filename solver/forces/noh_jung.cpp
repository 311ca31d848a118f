#include "solver/forces/noh_jung.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "mesh/triangles/topology.h"

namespace drape {
namespace {

// One side of an edge, as one of its triangles sees it.
struct RestSide {
  int a, b;       // a < b
  double l;       // m
  double area;    // m^2
  int count = 1;  // number of triangles
};

const Triangle& at(const std::vector<Triangle>& triangles, int k) { return triangles[k]; }
const Vec3& at(const std::vector<Vec3>& positions, int k) { return positions[k]; }

// The sides of all edges, sorted; the sides of one edge that have the same length count as one.
std::vector<RestSide> rest_sides(const TriangleMesh& mesh, const TriangleMesh& rest) {
  std::vector<RestSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (int counted : counted_triangles(mesh)) {
    const Triangle &t = at(mesh.triangles, counted), &r = at(rest.triangles, counted);
    const double area = triangle_area(rest, r);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const double l = (at(rest.positions, r[k]) - at(rest.positions, r[next])).norm();
      sides.push_back({std::min(t[k], t[next]), std::max(t[k], t[next]), l, area});
    }
  }
  std::stable_sort(sides.begin(), sides.end(), [](const RestSide& s, const RestSide& t) {
    return std::tie(s.a, s.b, s.l) < std::tie(t.a, t.b, t.l);
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    constexpr double same = 1e-9;  // relative: lengths that differ only by the rounding of a file
    RestSide* const last = kept > 0 ? &sides[kept - 1] : nullptr;
    if (last && last->a == sides[k].a && last->b == sides[k].b && sides[k].l <= last->l * (1 + same)) {
      last->area += sides[k].area;
      ++last->count;
    } else {
      sides[kept++] = sides[k];
    }
  }
  sides.resize(kept);
  return sides;
}

std::vector<StretchConnection> stretch_connections(const TriangleMesh& mesh, const TriangleMesh& rest,
                                                   const Fabric& fabric) {
  std::vector<StretchConnection> out;
  const std::vector<RestSide> sides = rest_sides(mesh, rest);
  const double Y = mean_stretch(fabric);
  out.reserve(sides.size());
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    int triangles = 0;  // of the edge, over all its lengths
    for (; last < sides.size() && sides[last].a == sides[first].a && sides[last].b == sides[first].b; ++last)
      triangles += sides[last].count;
    for (std::size_t k = first; k < last; ++k) {
      const RestSide& s = sides[k];
      double stiffness = s.l == 0 ? Y : Y * s.area / (s.l * s.l);
      if (fabric.stretch_spring) stiffness = *fabric.stretch_spring * s.count / triangles;
      out.push_back({s.a, s.b, s.l, stiffness});
    }
  }
  return out;
}

// A hinge at rest: the length of its edge, the rest length across it, and the heights of c and d over the
// edge.
struct RestHinge {
  double l, L, h1, h2;  // m
};

// The corners of the rest shape's triangle that correspond to these vertices of the cloth's triangle.
std::array<Vec3, 3> corners(const TriangleMesh& mesh, const TriangleMesh& rest, int triangle,
                            const std::array<int, 3>& vertices) {
  std::array<Vec3, 3> found;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      if (at(mesh.triangles, triangle)[i] == vertices[k])
        found[k] = at(rest.positions, at(rest.triangles, triangle)[i]);
  return found;
}

// The rest lengths of a hinge. All of them are 0 where the edge has no length.
RestHinge rest_hinge(const TriangleMesh& mesh, const TriangleMesh& rest, const Hinge& hinge) {
  const std::array<Vec3, 3> one = corners(mesh, rest, hinge.tc, {hinge.a, hinge.b, hinge.c}),
                            two = corners(mesh, rest, hinge.td, {hinge.a, hinge.b, hinge.d});
  const Vec3 along1 = one[1] - one[0], along2 = two[1] - two[0];
  const double l1 = along1.norm(), l2 = along2.norm();
  if (l1 == 0 || l2 == 0) return {0, 0, 0, 0};
  RestHinge r{l1, 0, along1.cross(one[2] - one[0]).norm() / l1, along2.cross(two[2] - two[0]).norm() / l2};
  const Vec3 n1 = along1.cross(one[2] - one[0]), n2 = along2.cross(two[2] - two[0]);
  const bool on_one_side = n1.dot(n2) > (1 - 1e-9) * n1.norm() * n2.norm();  // mirrored texture coordinates
  if (one[0] == two[0] && one[1] == two[1] && !on_one_side) {
    r.L = (two[2] - one[2]).norm();
  } else {  // cut here: unfolded into a plane, each side measured from the middle of its edge
    r.l = 0.5 * (l1 + l2);
    const double foot1 = along1.dot(one[2] - one[0]) / l1 - 0.5 * l1,
                 foot2 = along2.dot(two[2] - two[0]) / l2 - 0.5 * l2;
    r.L = std::hypot(r.h1 + r.h2, foot1 - foot2);
  }
  return r;
}

std::vector<BendConnection> bend_connections(const TriangleMesh& mesh, const TriangleMesh& rest,
                                             const Fabric& fabric) {
  std::vector<BendConnection> out;
  const double B = mean_bend(fabric);
  for (const Hinge& hinge : hinges(mesh)) {
    auto [l, L, h1, h2] = rest_hinge(mesh, rest, hinge);
    if (l == 0 || L == 0) continue;
    // Slivers would be infinitely stiff, so a height counts for at least a fifth of the edge.
    if (h1 < 1e-9 * l || h2 < 1e-9 * l) continue;
    h1 = std::max(h1, 0.2 * l);
    h2 = std::max(h2, 0.2 * l);
    const double per_rigidity = l * L * L * L / (6 * h1 * h2 * (h1 + h2));
    const double k_b = fabric.bend_spring.value_or(B * per_rigidity);
    const double clamp_k2 = 96 * k_b / (L * h1 * h2 * (h1 + h2) * (h1 + h2));
    if (!out.empty() && out.back().i == hinge.c && out.back().j == hinge.d) {
      if (!fabric.bend_spring) out.back().k_b += k_b;
      out.back().clamp_k2 = std::max(out.back().clamp_k2, clamp_k2);
    } else {
      out.push_back({hinge.c, hinge.d, L, k_b, clamp_k2, k_b / per_rigidity});
    }
  }
  return out;
}

}  // namespace

Connections noh_jung_connections(const TriangleMesh& mesh, const TriangleMesh& rest, const Fabric& fabric) {
  check(fabric);
  return {stretch_connections(mesh, rest, fabric), bend_connections(mesh, rest, fabric)};
}

std::vector<double> masses(const TriangleMesh& mesh, const Fabric& fabric) {
  std::vector<double> lumped = lumped_mass(mesh, fabric.area_density);
  if (!fabric.neighbour_weighting) return lumped;
  return neighbour_weighted(std::move(lumped), noh_jung_connections(mesh, mesh, fabric));
}

std::vector<std::unique_ptr<Force>> noh_jung(const TriangleMesh& mesh, const Fabric& fabric,
                                             int first_particle) {
  return forces_of(noh_jung_connections(mesh, mesh, fabric), fabric, first_particle);
}

}  // namespace drape
