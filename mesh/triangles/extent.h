// How far points reach: their box along the axes, an Eigen::AlignedBox. The box of no points isEmpty().
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

template <class Point>
Eigen::AlignedBox<double, Point::RowsAtCompileTime> box_of(const std::vector<Point>& points) {
  Eigen::AlignedBox<double, Point::RowsAtCompileTime> box;
  for (const Point& x : points) box.extend(x);
  return box;
}

// The box of the vertices that belong to a triangle; stray vertices do not count.
inline Eigen::AlignedBox3d box_of(const std::vector<Vec3>& positions,
                                  const std::vector<Triangle>& triangles) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : triangles)
    for (const int v : t) box.extend(positions[v]);
  return box;
}

}  // namespace drape
