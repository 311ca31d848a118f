// The built-in shapes, one block for each: what kind it is, where its surface is, what it weighs, how it
// looks, and which sizes it may have. std::visit puts the questions of shape.h to the block of the shape.
// They are called as kinds::..., whose parameters nothing converts to: a shape that lacks an answer does not
// compile.
//
// Moments of inertia of a solid of uniform density about its own axes, m mass [kg]:
//   sphere   2/5 m r^2
//   box      m/12 (b^2 + c^2), a b c the edges
//   capsule  a cylinder (mass m_c, length l) and two half spheres (m_s together), in the ratio of volumes:
//            along  m_c r^2/2 + 2/5 m_s r^2
//            across m_c (l^2/12 + r^2/4) + m_s (2/5 r^2 + l^2/4 + 3/8 l r)
//   plate    of discs of radius rho(z) along the axis, density m / V:
//            V = pi int rho^2,  along pi/2 int rho^4,  across pi/4 int rho^4 + pi int z^2 rho^2
#include "constraints/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "constraints/mesh_kinds.h"
#include "mesh/base/errors.h"
#include "mesh/base/match.h"
#include "mesh/triangles/generate.h"

namespace drape {

using namespace internal;

namespace {

using Eigen::AlignedBox3d;
using std::numbers::pi;

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr int fineness = 4;  // subdivisions of a sphere
constexpr int around = 96;   // vertices

// A unit vector across the unit vector n.
Vec3 across(const Vec3& n) { return n.unitOrthogonal(); }

Vec3 direction_or(const Vec3& v, double length, const Vec3& otherwise) {
  return length > 0 ? Vec3(v / length) : otherwise;
}

// The turn that takes `from`, a unit vector, to the direction `to`.
Mat3 turn(const Vec3& from, const Vec3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

TriangleMesh placed(TriangleMesh mesh, const Mat3& rotation, const Vec3& translate) {
  for (Vec3& x : mesh.positions) x = rotation * x + translate;
  return mesh;
}

UniformSolid solid(double volume, const Vec3& centre, const Mat3& axes, const Vec3& moments) {
  return {volume, centre, axes * moments.asDiagonal() * axes.transpose()};
}

// The box of a shape from how far it reaches along a direction: reach(u) = max u . (x - centre), |u| = 1.
template <class Reach>
AlignedBox3d box_about(const Vec3& centre, const Reach& reach) {
  Vec3 lower, upper;
  for (int k = 0; k < 3; ++k) {
    lower[k] = centre[k] - reach(Vec3(-Vec3::Unit(k)));
    upper[k] = centre[k] + reach(Vec3(Vec3::Unit(k)));
  }
  return {lower, upper};
}

// The length of the part of a unit vector across an axis, from its part along the axis.
double across_part(double along) { return std::sqrt(std::max(0.0, 1 - along * along)); }

void require(bool fine, const char* message, double value) {
  if (!fine) throw InputError(std::string(message) + ", it is " + std::to_string(value));
}

void require_size(double value, const char* message) {
  require(std::isfinite(value) && value > 0, message, value);
}

void require_place(const Vec3& p, const char* message) {
  if (!p.allFinite()) throw InputError(message);
}

void require_direction(const Vec3& n, const char* message) {
  require(n.allFinite() && n.norm() > 0, message, n.norm());
}

}  // namespace

namespace internal::kinds {

// ---- plane

constexpr Nature nature(const Plane&) { return {"plane", true, false}; }

SurfacePoint closest(const Plane& plane, const Vec3& x) {
  const Vec3 n = plane.normal.normalized();
  return {n.dot(x - plane.point), n};
}

Vec3 middle_of(const Plane& plane) { return plane.point; }
void make_unit(Plane& plane) { plane.normal.normalize(); }
Mat3 axes_of(const Plane&) { return Mat3::Identity(); }

// The half space of a plane has a bound only where its normal is along an axis of the world.
AlignedBox3d bounds_of(const Plane& plane) {
  const Vec3 n = plane.normal.normalized();
  Vec3 lower = Vec3::Constant(-endless), upper = -lower;
  for (int k = 0; k < 3; ++k) {
    if (n[k] == 1) upper[k] = plane.point[k];
    if (n[k] == -1) lower[k] = plane.point[k];
  }
  return {lower, upper};
}

TriangleMesh mesh_of(const Plane&, int) { return {}; }
std::optional<UniformSolid> uniform_solid(const Plane&, double) { return std::nullopt; }
double longest_edge(const Plane&) { return endless; }

void check(const Plane& plane) {
  require_place(plane.point, "plane: point must be finite");
  require_direction(plane.normal, "plane: normal must have a length");
}

// ---- sphere

constexpr Nature nature(const Sphere&) { return {"sphere", true, true}; }

SurfacePoint closest(const Sphere& sphere, const Vec3& x) {
  const Vec3 r = x - sphere.centre;
  const double d = r.norm();
  return {d - sphere.radius, direction_or(r, d, Vec3::UnitY())};
}

Vec3 middle_of(const Sphere& sphere) { return sphere.centre; }
void make_unit(Sphere&) {}
Mat3 axes_of(const Sphere&) { return Mat3::Identity(); }

AlignedBox3d bounds_of(const Sphere& sphere) {
  return box_about(sphere.centre, [&](const Vec3&) { return sphere.radius; });
}

TriangleMesh mesh_of(const Sphere& sphere, int coarser) {
  return placed(drape::sphere(fineness - coarser, sphere.radius), Mat3::Identity(), sphere.centre);
}

std::optional<UniformSolid> uniform_solid(const Sphere& sphere, double mass) {
  const double r = sphere.radius;
  return solid(4 * pi / 3 * r * r * r, sphere.centre, axes_of(sphere), Vec3::Constant(0.4 * mass * r * r));
}

double longest_edge(const Sphere& sphere) { return sphere.radius; }

void check(const Sphere& sphere) {
  require_place(sphere.centre, "sphere: centre must be finite");
  require_size(sphere.radius, "sphere: radius must be positive");
}

// ---- bowl

constexpr Nature nature(const Bowl&) { return {"bowl", false, false}; }

// The middle surface of the shell is half a sphere: for a point below its rim the nearest point of it lies
// along the radius, for one above on the rim.
SurfacePoint closest(const Bowl& bowl, const Vec3& x) {
  const Vec3 axis = bowl.axis.normalized();
  const double middle = bowl.radius + bowl.thickness / 2;
  const Vec3 r = x - bowl.centre;
  const double height = axis.dot(r);
  Vec3 outwards = r;
  if (height > 0) outwards -= height * axis;
  const double length = outwards.norm();
  const Vec3 radial = direction_or(outwards, length, height > 0 ? across(axis) : Vec3(-axis));
  const Vec3 offset =
      height > 0 ? Vec3((length - middle) * radial + height * axis) : Vec3((length - middle) * radial);
  const double d = offset.norm();
  return {d - bowl.thickness / 2, direction_or(offset, d, radial)};
}

Vec3 middle_of(const Bowl& bowl) { return bowl.centre; }
void make_unit(Bowl& bowl) { bowl.axis.normalize(); }
Mat3 axes_of(const Bowl& bowl) { return turn(Vec3::UnitX(), bowl.axis); }

// The bowl reaches as far as the outer half sphere downwards, and as far as the ring that is its rim upwards.
AlignedBox3d bounds_of(const Bowl& bowl) {
  const Vec3 axis = bowl.axis.normalized();
  const double half = bowl.thickness / 2;
  return box_about(bowl.centre, [&](const Vec3& u) {
    const double up = axis.dot(u);
    return up > 0 ? (bowl.radius + half) * across_part(up) + half : bowl.radius + bowl.thickness;
  });
}

TriangleMesh mesh_of(const Bowl& bowl, int coarser) {
  return placed(drape::bowl(around >> coarser, bowl.radius, bowl.thickness), turn(Vec3::UnitY(), bowl.axis),
                bowl.centre);
}

std::optional<UniformSolid> uniform_solid(const Bowl&, double) { return std::nullopt; }
double longest_edge(const Bowl&) { return endless; }

void check(const Bowl& bowl) {
  require_place(bowl.centre, "bowl: centre must be finite");
  require_size(bowl.radius, "bowl: radius must be positive");
  require_size(bowl.thickness, "bowl: thickness must be positive");
  require_direction(bowl.axis, "bowl: axis must have a length");
}

// ---- box

constexpr Nature nature(const Box&) { return {"box", true, true}; }

SurfacePoint closest(const Box& box, const Vec3& x) {
  const Vec3 p = box.rotation.transpose() * (x - box.centre);
  const Vec3 depth = p.cwiseAbs() - box.size / 2;  // how far beyond each pair of faces
  const Vec3 sign = p.unaryExpr([](double c) { return c < 0 ? -1.0 : 1.0; });
  const Vec3 beyond = depth.cwiseMax(0.0);
  const double d = beyond.norm();
  if (d > 0) return {d, box.rotation * beyond.cwiseProduct(sign) / d};
  int nearest;
  const double inside = depth.maxCoeff(&nearest);
  return {inside, sign[nearest] * box.rotation.col(nearest)};
}

Vec3 middle_of(const Box& box) { return box.centre; }
void make_unit(Box&) {}
Mat3 axes_of(const Box& box) { return box.rotation; }

AlignedBox3d bounds_of(const Box& box) {
  return box_about(
      box.centre, [&](const Vec3& u) { return (box.rotation.transpose() * u).cwiseAbs().dot(box.size / 2); });
}

TriangleMesh mesh_of(const Box& box, int) { return placed(drape::box(box.size), box.rotation, box.centre); }

std::optional<UniformSolid> uniform_solid(const Box& box, double mass) {
  const Vec3 squares = box.size.cwiseAbs2();
  return solid(box.size.prod(), box.centre, axes_of(box),
               mass / 12 * (Vec3::Constant(squares.sum()) - squares));
}

double longest_edge(const Box&) { return endless; }

void check(const Box& box) {
  require_place(box.centre, "box: centre must be finite");
  for (int k = 0; k < 3; ++k) require_size(box.size[k], "box: size must be positive");
  const double error = (box.rotation.transpose() * box.rotation - Mat3::Identity()).cwiseAbs().maxCoeff();
  require(
      error < 1e-6 && box.rotation.determinant() > 0,
      "box: rotation must be orthonormal and right-handed, the largest entry of |R^T R - 1| shows how far",
      error);
}

// ---- capsule

constexpr Nature nature(const Capsule&) { return {"capsule", true, true}; }

SurfacePoint closest(const Capsule& capsule, const Vec3& x) {
  const Vec3 ab = capsule.b - capsule.a, ax = x - capsule.a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp(ab.dot(ax) / squared, 0.0, 1.0) : 0.0;
  const Vec3 r = ax - t * ab;
  const double d = r.norm();
  const Vec3 otherwise = squared > 0 ? across(ab.normalized()) : Vec3::UnitY();
  return {d - capsule.radius, direction_or(r, d, otherwise)};
}

Vec3 middle_of(const Capsule& capsule) { return (capsule.a + capsule.b) / 2; }
void make_unit(Capsule&) {}
Mat3 axes_of(const Capsule& capsule) { return turn(Vec3::UnitX(), capsule.b - capsule.a); }

AlignedBox3d bounds_of(const Capsule& capsule) {
  const Vec3 reach = Vec3::Constant(capsule.radius);
  return {capsule.a.cwiseMin(capsule.b) - reach, capsule.a.cwiseMax(capsule.b) + reach};
}

TriangleMesh mesh_of(const Capsule& capsule, int coarser) {
  const Vec3 along = capsule.b - capsule.a;
  const double length = along.norm();
  return placed(drape::capsule(around >> coarser, capsule.radius, length),
                length > 0 ? turn(Vec3::UnitY(), along) : Mat3(Mat3::Identity()), middle_of(capsule));
}

std::optional<UniformSolid> uniform_solid(const Capsule& capsule, double mass) {
  const double r = capsule.radius, l = (capsule.b - capsule.a).norm();
  const double cylinder = mass * l / (l + 4.0 / 3 * r), ends = mass - cylinder;
  const double along = cylinder * r * r / 2 + 0.4 * ends * r * r;
  const double across =
      cylinder * (l * l / 12 + r * r / 4) + ends * (0.4 * r * r + l * l / 4 + 0.375 * l * r);
  return solid(pi * r * r * (l + 4.0 / 3 * r), middle_of(capsule), axes_of(capsule), {along, across, across});
}

double longest_edge(const Capsule& capsule) { return capsule.radius; }

void check(const Capsule& capsule) {
  require_place(capsule.a, "capsule: a must be finite");
  require_place(capsule.b, "capsule: b must be finite");
  require_size(capsule.radius, "capsule: radius must be positive");
}

// ---- plate: a cylinder of radius - rim and half height - rim, the core, and all that is within `rim` of it

constexpr Nature nature(const Plate&) { return {"plate", true, true}; }

SurfacePoint closest(const Plate& plate, const Vec3& x) {
  const Vec3 axis = plate.axis.normalized(), r = x - plate.centre;
  const double height = axis.dot(r);
  const Vec3 outwards = r - height * axis;
  const double rho = outwards.norm();
  const Vec3 radial = direction_or(outwards, rho, across(axis));
  const Vec3 upwards = height < 0 ? Vec3(-axis) : axis;
  const double beside = rho - (plate.radius - plate.rim);  // how far beyond the core's wall
  const double above = std::abs(height) - (plate.height / 2 - plate.rim);
  const double out = std::max(beside, 0.0), up = std::max(above, 0.0);
  const double d = std::sqrt(out * out + up * up);
  if (d > 0) return {d - plate.rim, (out * radial + up * upwards) / d};
  return {std::max(beside, above) - plate.rim, beside > above ? radial : upwards};
}

Vec3 middle_of(const Plate& plate) { return plate.centre; }
void make_unit(Plate& plate) { plate.axis.normalize(); }
Mat3 axes_of(const Plate& plate) { return turn(Vec3::UnitX(), plate.axis); }

AlignedBox3d bounds_of(const Plate& plate) {
  const Vec3 axis = plate.axis.normalized();
  return box_about(plate.centre, [&](const Vec3& u) {
    const double along = std::abs(axis.dot(u));
    return (plate.height / 2 - plate.rim) * along + (plate.radius - plate.rim) * across_part(along) +
           plate.rim;
  });
}

TriangleMesh mesh_of(const Plate& plate, int coarser) {
  const int round_the_rim = 8 >> coarser;  // pieces in a quarter of a circle
  const double half = plate.height / 2, wall = half - plate.rim, core = plate.radius - plate.rim;
  Outline outline;
  outline.emplace_back(0, -half);
  if (plate.rim > 0) {
    add_arc(outline, {core, -wall}, plate.rim, -pi / 2, 0, round_the_rim);
    add_arc(outline, {core, wall}, plate.rim, 0, pi / 2, round_the_rim);
  } else {
    outline.emplace_back(plate.radius, -half);
    outline.emplace_back(plate.radius, half);
  }
  if (outline.back()[0] > 0) outline.emplace_back(0, half);
  return placed(turned(outline, around >> coarser), turn(Vec3::UnitY(), plate.axis), plate.centre);
}

// Along the axis, the core's part is a cylinder. Beyond it, at t in [0, r] past its end, the disc's radius is
// rho = c + s with s = sqrt(r^2 - t^2), where c is the core's radius and r the rim; the integrals of t^i s^j
// over t have closed forms.
std::optional<UniformSolid> uniform_solid(const Plate& plate, double mass) {
  const double R = plate.radius, r = plate.rim, c = R - r, H = plate.height / 2 - r;
  const double r2 = r * r, r3 = r2 * r, r4 = r3 * r, r5 = r4 * r, c2 = c * c;
  // The integrals of rho^2, of t rho^2 and of t^2 rho^2 over t; then that of rho^4.
  const double rho2 = c2 * r + c * pi * r2 / 2 + 2 * r3 / 3;
  const double t_rho2 = c2 * r2 / 2 + 2 * c * r3 / 3 + r4 / 4;
  const double t2_rho2 = c2 * r3 / 3 + c * pi * r4 / 8 + 2 * r5 / 15;
  const double rho4 =
      c2 * c2 * r + c2 * c * pi * r2 + 4 * c2 * r3 + 3 * pi * c * r4 / 4 + 8 * r5 / 15;  // int rho^4
  const double volume = 2 * pi * (R * R * H + rho2);
  const double fourth = 2 * (R * R * R * R * H + rho4);  // over the whole axis
  const double second = 2 * (R * R * H * H * H / 3 + H * H * rho2 + 2 * H * t_rho2 + t2_rho2);
  const double along = mass / volume * pi / 2 * fourth, across = along / 2 + mass / volume * pi * second;
  return solid(volume, plate.centre, axes_of(plate), {along, across, across});
}

double longest_edge(const Plate& plate) { return plate.radius; }

void check(const Plate& plate) {
  require_place(plate.centre, "plate: centre must be finite");
  require_size(plate.radius, "plate: radius must be positive");
  require_size(plate.height, "plate: height must be positive");
  require_direction(plate.axis, "plate: axis must have a length");
  const double most = std::min(plate.radius, plate.height / 2);
  require(plate.rim >= 0 && plate.rim <= most,
          "plate: rim must be from 0 to the radius, and at most half the height", plate.rim);
}

Nature nature_of(const Shape& shape) {
  return std::visit([](const auto& kind) { return kinds::nature(kind); }, shape);
}

}  // namespace internal::kinds

std::string_view name(const Shape& shape) { return kinds::nature_of(shape).name; }
bool convex(const Shape& shape) { return kinds::nature_of(shape).convex; }
bool can_react(const Shape& shape) { return kinds::nature_of(shape).reacts; }

SurfacePoint closest(const Shape& shape, const Vec3& x, double s) {
  return std::visit(Match{[&](const DeformingBody& body) { return kinds::closest(body, x, s); },
                          [&](const auto& standing) { return kinds::closest(standing, x); }},
                    shape);
}

Vec3 middle_of(const Shape& shape) {
  return std::visit([](const auto& kind) { return kinds::middle_of(kind); }, shape);
}

Mat3 axes_of(const Shape& shape) {
  return std::visit([](const auto& kind) { return kinds::axes_of(kind); }, shape);
}

Eigen::AlignedBox3d bounds_of(const Shape& shape) {
  return std::visit([](const auto& kind) { return kinds::bounds_of(kind); }, shape);
}

void make_unit(Shape& shape) {
  std::visit([](auto& kind) { kinds::make_unit(kind); }, shape);
}

TriangleMesh mesh_of(const Shape& shape, int coarser) {
  return std::visit([coarser](const auto& kind) { return kinds::mesh_of(kind, coarser); }, shape);
}

std::optional<UniformSolid> uniform_solid(const Shape& shape, double mass) {
  return std::visit([&](const auto& kind) { return kinds::uniform_solid(kind, mass); }, shape);
}

double longest_edge(const Shape& shape) {
  return std::visit([](const auto& kind) { return kinds::longest_edge(kind); }, shape);
}

void check(const Shape& shape) {
  std::visit([](const auto& kind) { kinds::check(kind); }, shape);
}

void move(Shape& shape, double t0, double t1) {
  if (const DeformingBody* const body = deforming(shape)) body->surface->move(*body->frames, t0, t1);
}

double largest_displacement(const Shape& shape) {
  const DeformingBody* const body = deforming(shape);
  return body ? body->surface->largest_displacement() : 0;
}

Vec3 carried(const Shape& shape, const Vec3& x, double s) {
  const DeformingBody* const body = deforming(shape);
  if (!body || body->surface->largest_displacement() == 0) return x;
  return body->surface->carried(x, s);
}

}  // namespace drape
