// Moments of inertia of a solid of uniform density about its own axes, m mass [kg]:
//   sphere   2/5 m r^2
//   box      m/12 (b^2 + c^2), a b c the edges
//   capsule  a cylinder (mass m_c, length l) and two half spheres (m_s together), in the ratio of volumes:
//            along  m_c r^2/2 + 2/5 m_s r^2
//            across m_c (l^2/12 + r^2/4) + m_s (2/5 r^2 + l^2/4 + 3/8 l r)
#include "app/scene/rigid_read.h"

#include <Eigen/Geometry>

#include "app/scene/motion_read.h"
#include "mesh/base/errors.h"

namespace drape {
namespace {

constexpr double round_off = 1e-9;

Vec3 solid_moments(const Sphere& sphere, double mass) {
  return Vec3::Constant(0.4 * mass * sphere.radius * sphere.radius);
}

Vec3 solid_moments(const Box& box, double mass) {
  const Vec3 squares = box.size.cwiseAbs2();
  return mass / 12 * (Vec3::Constant(squares.sum()) - squares);
}

Vec3 solid_moments(const Capsule& capsule, double mass) {
  const double r = capsule.radius, l = (capsule.b - capsule.a).norm();
  const double cylinder = mass * l / (l + 4.0 / 3 * r), ends = mass - cylinder;
  const double along = cylinder * r * r / 2 + 0.4 * ends * r * r;
  const double across =
      cylinder * (l * l / 12 + r * r / 4) + ends * (0.4 * r * r + l * l / 4 + 0.375 * l * r);
  return {along, across, across};
}

// The body's own axes as columns.
Mat3 own_axes(const ObstacleEntry& entry) {
  const Shape& shape = entry.obstacle.shape;
  if (const Box* const box = std::get_if<Box>(&shape)) return box->rotation;
  if (const Capsule* const capsule = std::get_if<Capsule>(&shape))
    return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), capsule->b - capsule->a).toRotationMatrix();
  return entry.placement.rotation;
}

std::optional<Vec3> solid_moments(const Shape& shape, double mass) {
  if (const Sphere* const sphere = std::get_if<Sphere>(&shape)) return solid_moments(*sphere, mass);
  if (const Box* const box = std::get_if<Box>(&shape)) return solid_moments(*box, mass);
  if (const Capsule* const capsule = std::get_if<Capsule>(&shape)) return solid_moments(*capsule, mass);
  return std::nullopt;
}

void check_moments(const Table& table, const Vec3& inertia) {
  if (!(inertia.minCoeff() > 0)) table.fail("inertia", "expected three moments greater than zero");
  if (2 * inertia.maxCoeff() > (1 + round_off) * inertia.sum())
    table.fail("inertia", "no body has such moments: none may be more than the sum of the other two");
}

void read_inertia(Table& table, std::optional<Vec3>& inertia) {
  Vec3 moments = Vec3::Zero();
  table.read(
      "inertia", moments, dimension::moment_of_inertia,
      {"three moments about the axes through its middle: of a box along its edges, of a capsule along a b "
       "and twice across, else along x, y, z (a mesh's before rotate)",
       "a solid's"});
  if (!table.has("inertia")) return;
  check_moments(table, moments);
  inertia = moments;
}

}  // namespace

void read_rigid(Table& table, ObstacleEntry& entry, const Vec3& middle) {
  RigidBodyEntry rigid;
  table.read("mass", rigid.mass, dimension::mass, Range::positive,
             {"of a body that moves by what acts on it: not a plane or a bowl, and without motion",
              "none: it stands, or moves as `motion` says"});
  for (const char* key : {"inertia", "velocity", "spin"})
    if (table.has(key) && !table.has("mass"))
      table.fail(key,
                 "is of a body that moves by what acts on it, which needs a mass; a body that is moved has "
                 "motion = { velocity = [...], spin = { ... } }");
  if (!table.has("mass")) return;
  const std::string_view shape = name(entry.obstacle.shape);
  if (shape == "plane" || shape == "bowl")
    table.fail("mass", "a " + std::string(shape) + " cannot move by what acts on it; leave the mass out");
  if (table.has("motion"))
    table.fail("motion",
               "a body with a mass moves by what acts on it: give its first velocity and spin, or leave "
               "the mass out");
  table.only_of("with a mass");
  table.read("velocity", rigid.velocity, dimension::speed, "of its centre of mass, at first");
  rigid.spin = read_spin(table);
  std::optional<Vec3> inertia;
  read_inertia(table, inertia);
  table.only_of({});
  rigid.inertia = inertia ? inertia : solid_moments(entry.obstacle.shape, rigid.mass);
  rigid.axes = own_axes(entry);
  rigid.centre = middle;
  entry.rigid = rigid;
}

}  // namespace drape
