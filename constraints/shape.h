// Surfaces that answer signed distance and outward normal: positive outside the body, where the cloth may be.
//   plane    phi = n . (x - p)
//   sphere   phi = |x - c| - r
//   bowl     phi = distance to the arc of the middle radius - thickness / 2
//   box      exact distance to a box, turned by `rotation`
//   capsule  phi = distance to the segment a b - r
//   mesh     a triangle surface (mesh/distance/surface_distance.h), which stands in its own frame or deforms
//   level-set  a grid of distances to a closed one (mesh/level_set/level_set.h)
// The bowl is a hemispherical shell with a rounded rim, opening along +axis; `radius` is the inner one, the
// shell reaches out from it by `thickness`.
//
// Lengths in m. On the set where the normal is not defined (a sphere's centre) a fixed one is returned.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <variant>

#include "mesh/distance/surface_distance.h"
#include "mesh/level_set/level_set.h"

namespace drape {

struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  // any length but zero
};

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 1;  // m
};

struct Bowl {
  Vec3 centre = Vec3::Zero();
  double radius = 1;        // m, inner
  double thickness = 0.02;  // m
  Vec3 axis = Vec3::UnitY();
};

struct Box {
  Vec3 centre = Vec3::Zero();
  Vec3 size = Vec3::Ones();  // m, whole edge lengths
  Mat3 rotation = Mat3::Identity();
};

struct Capsule {
  Vec3 a = Vec3::Zero(), b = Vec3::UnitY();
  double radius = 1;  // m
};

using MeshBody = std::shared_ptr<const SurfaceDistance>;
using LevelSetBody = std::shared_ptr<const LevelSet>;

// A mesh whose vertices go from frame to frame; within a step each goes straight.
struct DeformingBody {
  std::shared_ptr<SurfaceDistance> surface;
  std::shared_ptr<const MeshFrames> frames;
};

using Shape = std::variant<Plane, Sphere, Bowl, Box, Capsule, MeshBody, DeformingBody, LevelSetBody>;

std::string_view name(const Shape& shape);  // "plane", "sphere", ...

// s [-] in [0, 1]: when within the step, where the shape deforms.
SurfacePoint closest(const Shape& shape, const Vec3& x, double s = 0);

// Only a DeformingBody does anything in a step: its surface goes from where it is at t0 to where it is at t1.
void move(Shape& shape, double t0, double t1);    // s
double largest_displacement(const Shape& shape);  // m: the most that a point of the surface moves in the step
// Where a point at s beside the surface is taken by it until s = 1.
Vec3 carried(const Shape& shape, const Vec3& x, double s = 0);

// Where the straight path from x0 (at s = 0) to x1 (at s = 1) first comes as near as `margin` to the surface:
// the fraction of the path in [0, 1] and the surface there. Nothing when it stays clear. Found by
// conservative advancement along the distance, so that a thin body is not stepped over (its limits:
// shape.cpp). A path that starts nearer than the margin meets the surface at once only if it comes nearer
// still; one that moves away is clear until it turns back towards the surface. The surface of a DeformingBody
// moves meanwhile, the fraction is s, and the surface is told as it is then; it may hit what does not move.
struct Hit {
  double fraction;
  SurfacePoint surface;
};
std::optional<Hit> first_hit(const Shape& shape, const Vec3& x0, const Vec3& x1, double margin);

// Throws InputError naming the field when a size is not positive or not finite, a normal zero, a rotation not
// orthonormal.
void check(const Shape& shape);

}  // namespace drape
