// The cloths and soft bodies of a scene as one list of triangles, and the segments of its ropes after them,
// to look for those that pass through each other (mesh/distance/triangle_crossings.h).
#pragma once

#include <string>
#include <vector>

#include "mesh/distance/triangle_crossings.h"
#include "solver/assembly/cloth.h"

namespace drape::app {

class Sheets {
 public:
  Sheets() = default;
  // All cloths and soft bodies, and then the ropes, where the particles are at x [m].
  Sheets(const std::vector<Cloth>& cloths, const VecX& x);

  void add(const std::string& name, const std::vector<Triangle>& triangles,
           const std::vector<Vec3>& positions);
  // A rope through these points; to be added after all triangles.
  void add_rope(const std::string& name, const std::vector<Vec3>& points);

  // Vertices at exactly the same place count as one, such as those of a seam that was merged.
  std::vector<CrossingContour> contours() const;
  int crossings() const { return crossing_count(contours()); }
  const std::string& name_of(int triangle) const;  // of the sheet that has it
  // For each sheet, in the order in which they were added, its triangles that cross another, ascending; of a
  // rope its segments.
  std::vector<std::vector<int>> crossing_triangles() const;

 private:
  std::size_t part_of(int triangle) const;

  struct Part {
    std::string name;
    int first_triangle;
  };
  std::vector<Part> parts_;
  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
  int segments_ = 0;  // so many of the last triangles
};

}  // namespace drape::app
