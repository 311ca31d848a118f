// Surfaces that answer signed distance and outward normal: positive outside the body, where the cloth may be.
//   plane    phi = n . (x - p)
//   sphere   phi = |x - c| - r
//   bowl     phi = distance to the arc of the middle radius - thickness / 2
//   box      exact distance to a box, turned by `rotation`
//   capsule  phi = distance to the segment a b - r
//   plate    phi = exact distance to a cylinder of radius - rim and height - 2 rim, less the rim
//   mesh     a triangle surface (mesh/distance/surface_distance.h), which stands in its own frame or deforms
//   level-set  a grid of distances to a closed one (mesh/level_set/level_set.h)
// The bowl is a hemispherical shell with a rounded rim, opening along +axis; `radius` is the inner one, the
// shell reaches out from it by `thickness`.
//
// Lengths in m. On the set where the normal is not defined (a sphere's centre) a fixed one is returned.
// Every question below is answered for every shape: what one of them lacks does not compile (shape.cpp).
#pragma once

#include <Eigen/Geometry>
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

// A cylinder whose two rims are rounded: the plate of drape tests.
struct Plate {
  Vec3 centre = Vec3::Zero();
  double radius = 1;     // m, with the rim
  double height = 0.02;  // m, along the axis
  double rim = 0;        // m, radius of the rounding: 0 to min(radius, height / 2)
  Vec3 axis = Vec3::UnitY();
};

using MeshBody = std::shared_ptr<const SurfaceDistance>;
using LevelSetBody = std::shared_ptr<const LevelSet>;

// A mesh whose vertices go from frame to frame; within a step each goes straight.
struct DeformingBody {
  std::shared_ptr<SurfaceDistance> surface;
  std::shared_ptr<const MeshFrames> frames;
};

using Shape = std::variant<Plane, Sphere, Bowl, Box, Capsule, Plate, MeshBody, DeformingBody, LevelSetBody>;

std::string_view name(const Shape& shape);  // "plane", "sphere", ...

// The part of a deforming mesh, the one kind that changes within a step; null for all others.
inline const DeformingBody* deforming(const Shape& shape) { return std::get_if<DeformingBody>(&shape); }

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
// first_hit.cpp). A path that starts nearer than the margin meets the surface at once only if it comes nearer
// still; one that moves away is clear until it turns back towards the surface. The surface of a DeformingBody
// moves meanwhile, the fraction is s, and the surface is told as it is then; it may hit what does not move.
struct Hit {
  double fraction;
  SurfacePoint surface;
};
std::optional<Hit> first_hit(const Shape& shape, const Vec3& x0, const Vec3& x1, double margin);

// Makes the directions that may have any length (a normal, an axis) one long.
void make_unit(Shape& shape);

// Where the shape is as a whole. A deforming mesh is taken as the mesh that it was made of.
Vec3 middle_of(const Shape& shape);  // m: the centre; of a plane its point, of a mesh that of its box
Mat3 axes_of(const Shape& shape);    // its own axes as columns; of a mesh those of the frame
Eigen::AlignedBox3d bounds_of(const Shape& shape);  // m; infinite where the shape has no end

// Its surface, wound outwards: no vertices for a plane, which has no end, and for a level set. Built-in shapes
// are drawn finely enough to look round (4 or 6 degrees an edge); their vertices lie on the true surface.
TriangleMesh mesh_of(const Shape& shape);

// The solid that a shape bounds, its mass spread evenly.
struct UniformSolid {
  double volume;  // m^3
  Vec3 centre;    // m, of mass
  Mat3 inertia;   // kg m^2, about the centre of mass
};
// mass [kg]. Nothing for a plane, a bowl, an open mesh and a mesh that deforms. That of a level set is a sum
// over its grid, good to some thousandths where it is thicker than some voxels.
std::optional<UniformSolid> uniform_solid(const Shape& shape, double mass);

// Whether every straight line meets the solid in one piece.
bool convex(const Shape& shape);

// Whether it may have a mass and move by what acts on it: not a plane and not a bowl.
bool can_react(const Shape& shape);

// m: contact is found at vertices only, so a body comes through a cloth whose edges are longer than half the
// least width of the body. Infinite for what is flat or hollow (plane, box, bowl), where this is no measure.
double longest_edge(const Shape& shape);

// Throws InputError naming the field when a size is not positive or not finite, a normal zero, a rotation not
// orthonormal.
void check(const Shape& shape);

}  // namespace drape
