// Cutting polygons into triangles.
//   quad     along the shorter diagonal that lies inside; where both are as long (to 1e-3), along the one
//            whose ends carry more diagonals: a grid of rectangles becomes a union jack, alike both ways
//   larger   ear clipping in the plane of Newell's normal (mesh/triangles/normals.h), best-shaped ear first
//            (area over the sum of squared edges)
// n corners give n - 2 triangles, wound like the polygon; concave, non-planar and self-touching polygons are
// allowed. A corner equal to the one before it is passed over, and so is a spike (1 2 1), which has no area:
// they give no triangle. No triangle names a vertex twice.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::internal {

class PolygonCutter {
 public:
  struct Outcome {
    bool repeated_corner = false;  // repeated corners or spikes were passed over
    bool folded = false;           // no inside was found (self-crossing, folded back): cut as a fan
  };

  explicit PolygonCutter(const std::vector<Vec3>& positions) : positions_(positions) {}

  // Appends the triangles of the polygon with these corners (vertex numbers).
  Outcome cut(const std::vector<int>& corners, std::vector<Triangle>& triangles);

 private:
  void cut_quad(std::vector<Triangle>& triangles);
  bool clip_ears(std::vector<Triangle>& triangles);
  void flatten();
  double ear_quality(int i, int strictness) const;

  const std::vector<Vec3>& positions_;
  std::vector<int> diagonals_at_;    // how many quad diagonals end at each vertex so far
  std::vector<int> corners_;         // of the polygon being cut
  std::vector<double> u_, w_;        // the corners in the plane of the polygon
  std::vector<int> before_, after_;  // neighbours among the corners that are left, as a ring
};

}  // namespace drape::internal
