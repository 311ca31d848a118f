// Which triangles of a surface lie over the convex hull of the shadow that some of them cast on a plane.
#pragma once

#include <array>
#include <vector>

#include "mesh/distance/surface_faces.h"

namespace drape::internal {

class ShadowHull {
 public:
  // The faces are joined.
  ShadowHull(const std::vector<Face>& faces, const std::vector<Vec3>& places);

  // Whether the surface around these faces covers the hull of their shadow, across the unit normal, once and
  // without a gap, by triangles that are hardly tilted. Then the following tell which they are, and of what
  // shape.
  bool covers(const std::vector<int>& faces, const Vec3& normal);
  const std::vector<int>& found() const { return found_; }
  double height() const { return height_; }  // the least of any triangle's shadow [m]
  double slope() const { return slope_; }    // the largest tangent of a triangle's tilt

 private:
  using Vec2 = Eigen::Vector2d;
  void add(int face);
  // The face beyond an edge; -1: there is none, or several, or it is wound the other way.
  int beyond(int face, int side) const;
  Vec3 normal_of(int face) const;  // twice the area long
  Vec2 shadow(int vertex) const { return {plane_[0].dot(places_[vertex]), plane_[1].dot(places_[vertex])}; }
  std::array<Vec2, 3> shadow_of(int face) const;
  void make_hull(const std::vector<int>& faces);
  bool enters_hull(const Vec2& a, const Vec2& b) const;
  bool is_beneath_another(int face) const;

  const std::vector<Face>& faces_;
  const std::vector<Vec3>& places_;
  std::vector<int> met_, seen_;  // the search that met the face, and the vertex, last
  int search_ = 0;
  std::array<Vec3, 2> plane_;
  std::vector<Vec2> points_, hull_;  // counterclockwise
  double size_ = 0;                  // m, of the hull
  std::vector<int> found_;
  double height_ = 0, slope_ = 0;
};

// Two unit vectors across n and each other, so that n is their cross product.
std::array<Vec3, 2> plane_across(const Vec3& n);

}  // namespace drape::internal
