// The moments of a solid that the scene does not give are those of its shape (constraints/shape.h).
#include "app/scene/rigid_read.h"

#include "app/scene/motion_read.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

constexpr double round_off = 1e-9;

// The body's own axes as columns.
Mat3 own_axes(const ObstacleEntry& entry) {
  return entry.mesh.empty() ? axes_of(entry.obstacle.shape) : entry.placement.rotation;
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
       "and of a plate along its axis and twice across, else along x, y, z (a mesh's before rotate)",
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
  if (!can_react(entry.obstacle.shape))
    table.fail("mass", "a " + std::string(name(entry.obstacle.shape)) +
                           " cannot move by what acts on it; leave the mass out");
  if (table.has("motion"))
    table.fail("motion",
               "a body with a mass moves by what acts on it: give its first velocity and spin, or leave "
               "the mass out");
  table.only_of("with a mass");
  table.read("velocity", rigid.velocity, dimension::speed, "of its centre of mass, at first");
  rigid.spin = read_spin(table);
  read_inertia(table, rigid.inertia);
  table.only_of({});
  rigid.axes = own_axes(entry);
  rigid.centre = middle;
  entry.rigid = rigid;
}

}  // namespace drape::app
