// A shape as it is drawn: a rope is a line of particles, and is drawn as a tube of its radius; all others are
// drawn as they are.
#pragma once

#include <vector>

#include "app/recording/recording.h"

namespace drape::app {

inline constexpr int tube_sides = 8;
inline constexpr int triangles_of_segment =
    2 * tube_sides;  // of a rope, from its first on; those of its ends come last

class DrawnShape {
 public:
  explicit DrawnShape(const RecordedShape& shape);

  bool is_tube() const { return radius_ > 0; }
  int vertices(int own) const { return is_tube() ? own * tube_sides : own; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  // Of the vertices that are drawn, for those of the shape [m].
  std::vector<Vec3> positions(std::vector<Vec3> own) const;
  // The value of each vertex that is drawn, for those of the shape.
  template <class Value>
  std::vector<Value> values(std::vector<Value> own) const {
    if (!is_tube()) return own;
    std::vector<Value> all;
    all.reserve(own.size() * tube_sides);
    for (const Value& value : own) all.insert(all.end(), tube_sides, value);
    return all;
  }

 private:
  double radius_ = 0;  // m, of a rope; 0 of all others
  std::vector<Triangle> triangles_;
};

}  // namespace drape::app
