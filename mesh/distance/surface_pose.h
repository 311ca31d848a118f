// A surface in one configuration: where its vertices are, and the normals of its faces there.
//   Standing  the surface as it was constructed; which faces have no area is known
//   Moving    the surface at s of a step, when every vertex goes straight from its start to its end
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "mesh/distance/closest_on_triangle.h"
#include "mesh/distance/crossing.h"
#include "mesh/distance/surface_faces.h"
#include "mesh/triangles/normals.h"

namespace drape::internal {

template <class Places>
class SurfacePose {
 public:
  SurfacePose(const SurfaceFaces& surface, Places places) : surface_(surface), places_(places) {}

  decltype(auto) corner(int f, int k) const { return places_(surface_.faces[f].v[k]); }
  bool flat(int f) const { return places_.flat(surface_, f); }
  const Places& places() const { return places_; }
  Vec3 plain_normal(int f) const;
  Vec3 angle_weighted(int f, int k) const;  // the normal of face f, weighted by its angle at corner k only
  Vec3 normal_beyond(int f, int side) const;

 private:
  int longest_side(int f) const;

  const SurfaceFaces& surface_;
  Places places_;
};

template <class Places>
int SurfacePose<Places>::longest_side(int f) const {
  double length[3];
  for (int k = 0; k < 3; ++k) length[k] = (corner(f, next(k)) - corner(f, k)).squaredNorm();
  return static_cast<int>(std::max_element(length, length + 3) - length);
}

// Unit normal of a face. A face without an area counts as a part of the face beyond its longest side.
template <class Places>
Vec3 SurfacePose<Places>::plain_normal(int f) const {
  if (flat(f)) {
    f = surface_.faces[f].across[longest_side(f)];
    if (f < 0 || flat(f)) return Vec3::Zero();
  }
  return twice_area_normal(corner(f, 0), corner(f, 1), corner(f, 2)).normalized();
}

template <class Places>
Vec3 SurfacePose<Places>::angle_weighted(int f, int k) const {
  const Vec3 p = corner(f, next(k)) - corner(f, k), q = corner(f, next(next(k))) - corner(f, k);
  return angle_between(p, q) * plain_normal(f);
}

// Normal of the surface beyond a side of a face. Two faces lie past the long side of a face without an area.
template <class Places>
Vec3 SurfacePose<Places>::normal_beyond(int f, int side) const {
  const int g = surface_.faces[f].across[side];
  if (g < 0) return Vec3::Zero();
  const int longest = flat(g) ? longest_side(g) : -1;
  if (longest < 0 || surface_.faces[g].across[longest] != f) return plain_normal(g);
  Vec3 sum = Vec3::Zero();
  for (int k : {next(longest), next(next(longest))})
    if (const int h = surface_.faces[g].across[k]; h >= 0 && !flat(h)) sum += plain_normal(h);
  return sum.normalized();
}

// Positions of the vertices in the mesh as it was constructed.
struct Standing {
  const std::vector<Vec3>& positions;
  const Vec3& operator()(int v) const { return positions[v]; }
  static bool flat(const SurfaceFaces& surface, int f) { return f >= surface.with_area; }
};

// Positions of the vertices on the way from start to end, at s.
struct Moving {
  const std::vector<Vec3>&start, &end;
  double s;
  Vec3 operator()(int v) const { return StraightWay{start[v], end[v]}.at(s); }
  bool flat(const SurfaceFaces& surface, int f) const {
    const Triangle& t = surface.faces[f].v;
    return !has_area((*this)(t[0]), (*this)(t[1]), (*this)(t[2]));
  }
};

}  // namespace drape::internal
