// Surfaces that answer with signed distance phi and outward normal: phi is positive outside the body, where
// the cloth may be.
//   plane    phi = n . (x - p)
//   sphere   phi = |x - c| - r
//   bowl     phi = distance to the arc of the middle radius - thickness / 2
//   box      exact distance to a box, turned by `rotation`
//   capsule  phi = distance to the segment a b - r
//   plate    phi = exact distance to a cylinder of radius - rim and height - 2 rim, less the rim
//   mesh     a triangle surface (mesh/distance/surface_distance.h), which stands in its own frame or deforms
//   level-set  a grid of distances to a closed surface (mesh/level_set/level_set.h)
// The bowl is a hemispherical shell with a rounded rim, opening along +axis; `radius` is the inner one, and
// the shell reaches out from it by `thickness`.
//
// Lengths are in m. Where the normal is not defined (at a sphere's centre) a fixed one is returned. Every
// question below is answered for every shape: a shape that lacks an answer does not compile (shape.cpp).
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
  Vec3 normal = Vec3::UnitY();  // of any length but zero
};

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 1;  // m
};

struct Bowl {
  Vec3 centre = Vec3::Zero();
  double radius = 1;        // inner radius [m]
  double thickness = 0.02;  // m
  Vec3 axis = Vec3::UnitY();
};

struct Box {
  Vec3 centre = Vec3::Zero();
  Vec3 size = Vec3::Ones();  // whole edge lengths [m]
  Mat3 rotation = Mat3::Identity();
};

struct Capsule {
  Vec3 a = Vec3::Zero(), b = Vec3::UnitY();
  double radius = 1;  // m
};

// A cylinder whose two rims are rounded: the plate on which drape is tested.
struct Plate {
  Vec3 centre = Vec3::Zero();
  double radius = 1;     // with the rim [m]
  double height = 0.02;  // along the axis [m]
  double rim = 0;        // radius of the rounding [m], 0 to min(radius, height / 2)
  Vec3 axis = Vec3::UnitY();
};

using MeshBody = std::shared_ptr<const SurfaceDistance>;
using LevelSetBody = std::shared_ptr<const LevelSet>;

// A mesh whose vertices go from frame to frame; within a step each vertex goes straight.
struct DeformingBody {
  std::shared_ptr<SurfaceDistance> surface;
  std::shared_ptr<const MeshFrames> frames;
};

using Shape = std::variant<Plane, Sphere, Bowl, Box, Capsule, Plate, MeshBody, DeformingBody, LevelSetBody>;

std::string_view name(const Shape& shape);  // "plane", "sphere", ...

// The deforming mesh, if the shape is one; null for all others. No other kind changes within a step.
inline const DeformingBody* deforming(const Shape& shape) { return std::get_if<DeformingBody>(&shape); }

// The closest point of the surface to x. s [-], from 0 to 1, is the time within the step, for a shape that
// deforms.
SurfacePoint closest(const Shape& shape, const Vec3& x, double s = 0);

// Only a DeformingBody changes in a step: its surface goes from where it is at t0 to where it is at t1.
void move(Shape& shape, double t0, double t1);    // s
double largest_displacement(const Shape& shape);  // the most that a point of it moves in the step [m]
// Where the surface carries a point that is beside it at s, until s = 1.
Vec3 carried(const Shape& shape, const Vec3& x, double s = 0);

// Where the straight path from x0 (at s = 0) to x1 (at s = 1) first comes as near as `margin` to the surface:
// the fraction of the path in [0, 1] and the surface there. Nothing when it stays clear. The search is a
// conservative advancement along the distance, so that a thin body is not stepped over (its limits:
// first_hit.cpp). A path that starts nearer than the margin meets the surface at once only if it comes nearer
// still; one that moves away is clear until it turns back towards the surface. The surface of a DeformingBody
// moves meanwhile: the fraction is s, the surface is the one at s, and it may hit a particle that does not
// move.
struct Hit {
  double fraction;
  SurfacePoint surface;
};
std::optional<Hit> first_hit(const Shape& shape, const Vec3& x0, const Vec3& x1, double margin);

// Gives the directions that may have any length (a normal, an axis) the length one.
void make_unit(Shape& shape);

// These say where the shape is as a whole. A deforming mesh is taken as the mesh that it was made of.
Vec3 middle_of(const Shape& shape);  // the centre [m]; of a plane its point, of a mesh the centre of its box
Mat3 axes_of(const Shape& shape);    // the shape's own axes as columns; of a mesh those of the frame
Eigen::AlignedBox3d bounds_of(const Shape& shape);  // [m]; infinite where the shape has no end

// The surface of the shape as triangles, wound outwards. It has no vertices for a plane, which has no end,
// and for a level set. Built-in shapes are drawn finely enough to look round (4 or 6 degrees an edge); their
// vertices lie on the true surface. coarser, 0 to 3: so many times the edges round a shape are twice as long;
// of a mesh they are its own.
TriangleMesh mesh_of(const Shape& shape, int coarser = 0);

// The solid that a shape bounds, with its mass spread evenly.
struct UniformSolid {
  double volume;  // m^3
  Vec3 centre;    // of mass [m]
  Mat3 inertia;   // about the centre of mass [kg m^2]
};
// mass [kg]. There is no solid for a plane, a bowl, an open mesh and a mesh that deforms. The solid of a
// level set is a sum over its grid, accurate to some thousandths where it is several voxels thick.
std::optional<UniformSolid> uniform_solid(const Shape& shape, double mass);

// Whether every straight line meets the solid in one piece.
bool convex(const Shape& shape);

// Whether the shape may have a mass and be moved by what acts on it: all may but the plane and the bowl.
bool can_react(const Shape& shape);

// The longest edge of a cloth that this body does not come through [m]: contact is found at vertices only, so
// it is half the least width of the body. It is infinite for shapes that are flat or hollow (plane, box,
// bowl), where this is no measure.
double longest_edge(const Shape& shape);

// Throws InputError, which names the field, when a size is not positive or not finite, a normal zero, or a
// rotation not orthonormal.
void check(const Shape& shape);

}  // namespace drape
