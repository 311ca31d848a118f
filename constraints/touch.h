// Where two bodies are near each other: the points at which they touch, or will touch within a step.
// A pair of bodies is answered in the first of these ways that fits:
//   plane     every corner of the body against the plane
//   sphere    its centre against the signed distance of the other body
//   convex    Bullet's search for the nearest points, and for flat faces the polygon in which they lie on each other
//             (constraints/hull.h); the two ends of a capsule count as spheres besides
//   any other the corners of each body against the signed distance of the other; two edges that cross are not found
// The first two and the last are exact for the corners that there are. A plate is taken as the polyhedron that it is
// drawn as, a level set as points of its surface.
// gap [m]: the distance between the two surfaces along the normal; negative where the bodies are inside each other.
#pragma once

#include <vector>

#include "constraints/hull.h"
#include "constraints/moving_body.h"

namespace drape {

struct Touch {
  Vec3 place;   // m, halfway between the two surfaces
  Vec3 normal;  // unit vector, from the second body to the first
  double gap;   // m
};

// A body as this search sees it, made once.
class TouchForm {
 public:
  explicit TouchForm(const Shape& shape);

  enum class Kind { plane, sphere, convex, any };
  Kind kind() const { return kind_; }
  double radius() const { return radius_; }  // m: of what lies round the corners and the hull
  const std::vector<Vec3>& corners() const { return corners_; }       // in the body's frame [m]
  int vertex(std::size_t corner) const { return vertices_[corner]; }  // of a mesh, which corner it is
  const Hull& hull() const { return hull_; }                          // only of a convex body
  // A ball round the body; its radius is infinite for a plane.
  const Vec3& middle() const { return middle_; }  // m, in the body's frame
  double reach() const { return reach_; }         // m

 private:
  Kind kind_;
  double radius_ = 0;
  std::vector<Vec3> corners_;
  std::vector<int> vertices_;
  Hull hull_;
  Vec3 middle_ = Vec3::Zero();
  double reach_ = 0;
};

// Whether the pair is answered by Bullet, which a build may be without.
bool needs_hulls(const TouchForm& a, const TouchForm& b);

// Finds where the bodies, as they are at the start of the step under way, are nearer than `reach` [m] to each other,
// at most a few dozen points that hold the bodies as well as all of them would. `found` is filled anew and keeps its
// memory.
void find_touches(const MovingBody& a, const TouchForm& form_a, const MovingBody& b, const TouchForm& form_b,
                  double reach, std::vector<Touch>& found);

}  // namespace drape
