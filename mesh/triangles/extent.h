// How far points reach: their box along the axes, an Eigen::AlignedBox. That of no points isEmpty().
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

// Of the vertices that carry triangles: a stray one counts for nothing.
inline Eigen::AlignedBox3d box_of(const std::vector<Vec3>& positions,
                                  const std::vector<Triangle>& triangles) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : triangles)
    for (const int v : t) box.extend(positions[v]);
  return box;
}

}  // namespace drape
