// The convex hull of points, and where two of them are nearest to each other, by the collision library Bullet
// in double precision.          [Gilbert, Johnson & Keerthi 1988; van den Bergh 2001 where the hulls overlap]
// A build without Bullet has no such hulls: available() is then false, and the other functions are not to be
// called. Internal to the library's constraints.
#pragma once

#include <memory>
#include <vector>

#include "constraints/pose.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct Touch;  // constraints/touch.h

class Hull {
 public:
  static bool available();

  Hull() = default;
  explicit Hull(const std::vector<Vec3>& points);  // m, in the body's frame; one point or more, without faces
  explicit Hull(const TriangleMesh& convex);       // closed, and bulges everywhere

  struct Shape;  // in Bullet's words: hull.cpp
  const Shape& shape() const { return *shape_; }

 private:
  std::shared_ptr<const Shape> shape_;
};

// A hull that stands at a place, and what lies round it within this radius [m].
struct PlacedHull {
  const Hull& hull;
  Pose pose;
  double radius;
};

// Adds the points at which a and b are nearer than `reach` [m] to each other: the corners of the polygon in
// which flat faces lie on each other, and the nearest points where no such corner is as near.
void add_touches(const PlacedHull& a, const PlacedHull& b, double reach, std::vector<Touch>& found);

}  // namespace drape
