#include "solver/forces/woven.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "mesh/base/errors.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/held_corner.h"
#include "solver/forces/hinge.h"
#include "solver/forces/membrane.h"
#include "solver/forces/plate_force.h"

namespace drape {

using internal::HeldCorner;

// Bent about the direction between warp and weft, a plate takes (D_11 + D_22 + 2 D_12) / 4 + D_66.
double least_bend_bias(const Fabric& fabric) {
  const double warp = fabric.bend, weft = fabric.weave.bend_weft.value_or(warp);
  return 0.25 * (warp + weft + 2 * fabric.weave.bend_poisson * std::sqrt(warp * weft));
}

PlateStiffness plate_of(const Fabric& fabric) {
  const Weave& weave = fabric.weave;
  const double warp = fabric.bend, weft = weave.bend_weft.value_or(warp), mean = std::sqrt(warp * weft),
               least = least_bend_bias(fabric);
  const double twist = weave.bend_bias ? *weave.bend_bias - least : 0.5 * (1 - weave.bend_poisson) * mean;
  if (weave.bend_bias && !(twist > 0)) {
    std::ostringstream message;
    message << "bend_bias = " << *weave.bend_bias
            << " N.m: with this bend, bend_weft and bend_poisson it has to be greater than " << least
            << " N.m";
    throw InputError(message.str());
  }
  return {warp, weft, weave.bend_poisson * mean, twist};
}

PlateFrictionLaw plate_friction_of(const Fabric& fabric) {
  const Weave& weave = fabric.weave;
  return {.warp = weave.bend_friction,
          .weft = weave.bend_friction_weft.value_or(weave.bend_friction),
          .onset = weave.bend_friction_onset};
}

bool has_directions(const Fabric& fabric) {
  const Weave& w = fabric.weave;
  return w.stretch_weft || w.shear || w.bend_weft || w.bend_bias || w.bend_friction_weft;
}

bool needs_warp(const Fabric& fabric) {
  const Weave& w = fabric.weave;
  return has_directions(fabric) || w.compression != 1 || w.stretch_time != w.shear_time;
}

namespace {

// The direction for every triangle.
std::vector<Vec3> for_all(const TriangleMesh& rest, const std::optional<Vec3>& warp) {
  if (warp && !(warp->allFinite() && warp->norm() > 0))
    throw InputError("warp: a direction is finite and not [0, 0, 0]");
  return std::vector<Vec3>(rest.triangles.size(), warp.value_or(Vec3::Zero()));
}

// By its number and by where it is: a file of polygons numbers its faces otherwise.
std::string describe(std::size_t triangle, const Vec3& corner) {
  std::ostringstream text;
  text.precision(4);
  text << "triangle " << triangle + 1 << ", at (" << corner.x() << ", " << corner.y() << ", " << corner.z()
       << ") m in the rest shape,";
  return text.str();
}

}  // namespace

std::vector<RestCorners> woven_corners(const TriangleMesh& rest, const std::vector<Vec3>& warps) {
  if (!warps.empty() && warps.size() != rest.triangles.size())
    throw InputError("warp: " + std::to_string(warps.size()) + " directions for " +
                     std::to_string(rest.triangles.size()) + " triangles");
  std::vector<RestCorners> all;
  all.reserve(rest.triangles.size());
  for (const Triangle& t : rest.triangles) {
    const auto at = [&](std::size_t k) { return rest.positions[static_cast<std::size_t>(t[k])]; };
    const Vec3 one = at(1) - at(0), two = at(2) - at(0), normal = one.cross(two).normalized();
    const Vec3 warp = warps.empty() ? Vec3(Vec3::Zero()) : warps[all.size()];
    if (!warp.allFinite()) throw InputError("warp: a direction is finite and not [0, 0, 0]");
    const bool known = !warp.isZero(0);
    Vec3 u = known ? Vec3(warp - normal.dot(warp) * normal) : one;
    if (known && !normal.isZero() && u.norm() < 1e-6 * warp.norm())
      throw InputError(describe(all.size(), at(0)) +
                       " is square to the warp: give a direction that lies in the cloth, or uv");
    u.normalize();
    const Vec3 v = normal.cross(u);
    all.push_back({Eigen::Vector2d(0, 0), {u.dot(one), v.dot(one)}, {u.dot(two), v.dot(two)}});
  }
  return all;
}

namespace {

// What holds the particles p of a triangle without area together; at: where its corners are at rest.
void add_held(const std::array<int, 3>& p, const std::array<Vec3, 3>& at,
              std::vector<StencilForce<HeldCorner>::Element>& held) {
  std::size_t m = 0;  // across from the longest edge
  const auto across = [&](std::size_t k) { return (at[(k + 2) % 3] - at[(k + 1) % 3]).norm(); };
  for (std::size_t k = 1; k < 3; ++k)
    if (across(k) > across(m)) m = k;
  const std::size_t a = (m + 1) % 3, b = (m + 2) % 3;
  const Vec3 along = at[b] - at[a];
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp((at[m] - at[a]).dot(along) / square, 0.0, 1.0) : 0;
  held.push_back({.particles = {p[m], p[a], p[b]}, .rest = {s}});
  if (square == 0) held.push_back({.particles = {p[b], p[a], p[m]}, .rest = {0}});  // all at one place
}

std::unique_ptr<Force> bending(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                               const Fabric& fabric, int first) {
  const PlateStiffness D = plate_of(fabric);
  const Weave& weave = fabric.weave;
  switch (weave.bending) {
    case Bending::hinges:
      return internal::hinge_force(mesh, corners, D, weave.rest_angle, weave.bend_time, first);
    case Bending::quadratic_hinges:
      return std::make_unique<PlateForce>(internal::quadratic_hinges(mesh, corners, D), weave.bend_time,
                                          first);
    case Bending::plate:
      break;
  }
  return std::make_unique<PlateForce>(plate_energy(mesh, corners, D, weave.rest_angle), weave.bend_time,
                                      first);
}

}  // namespace

std::vector<std::unique_ptr<Force>> woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                          const Fabric& fabric, const std::optional<Vec3>& warp, int first,
                                          std::shared_ptr<BendMemory> memory) {
  return woven(mesh, rest, fabric, for_all(rest, warp), first, std::move(memory));
}

std::vector<std::unique_ptr<Force>> woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                          const Fabric& fabric, const std::vector<Vec3>& warp, int first,
                                          std::shared_ptr<BendMemory> memory) {
  check(fabric);
  if (rest.triangles.size() != mesh.triangles.size())
    throw InputError("the rest shape has " + std::to_string(rest.triangles.size()) +
                     " triangles and the mesh " + std::to_string(mesh.triangles.size()) +
                     "; triangle k of the one is triangle k of the other");
  if (fabric.stretch_spring || fabric.bend_spring || fabric.buckling_clamp || fabric.neighbour_weighting)
    throw InputError(
        "stretch_spring, bend_spring, buckling_clamp and neighbour_weighting are of connections, and a woven "
        "cloth has none; give stretch and bend");
  const auto unknown = std::find_if(warp.begin(), warp.end(), [](const Vec3& u) { return u.isZero(0); });
  if (needs_warp(fabric) && unknown != warp.end())
    throw InputError(
        "the fabric differs along warp and weft, or wrinkles or is viscous along them, and where the "
        "warp runs in triangle " +
        std::to_string(unknown - warp.begin() + 1) + " is not known; give its direction");
  const std::vector<RestCorners> corners = woven_corners(rest, warp);
  std::vector<std::unique_ptr<Force>> forces;
  if (fabric.stretch > 0) {
    std::vector<StencilForce<Membrane>::Element> triangles;
    std::vector<StencilForce<HeldCorner>::Element> held;
    for (int t : counted_triangles(mesh)) {
      const auto k = static_cast<std::size_t>(t);
      const Membrane::Rest at_rest = slopes_of(corners[k]);
      const Triangle& v = mesh.triangles[k];
      const std::array<int, 3> particles = {first + v[0], first + v[1], first + v[2]};
      const auto at = [&](int corner) {
        return rest.positions[static_cast<std::size_t>(rest.triangles[k][static_cast<std::size_t>(corner)])];
      };
      if (at_rest.area > 0)
        triangles.push_back({.particles = particles, .rest = at_rest});
      else
        add_held(particles, {at(0), at(1), at(2)}, held);
    }
    forces.push_back(std::make_unique<StencilForce<Membrane>>(std::move(triangles), membrane_of(fabric)));
    if (!held.empty())
      forces.push_back(
          std::make_unique<StencilForce<HeldCorner>>(std::move(held), HeldCorner::Common{fabric.stretch}));
  }
  if (fabric.bend > 0) {
    forces.push_back(bending(mesh, corners, fabric, first));
  }
  if (fabric.weave.bend_friction > 0) {
    if (!memory) memory = std::make_shared<BendMemory>();
    forces.push_back(std::make_unique<PlateFriction>(plate_curvatures(mesh, corners, plate_of(fabric)),
                                                     plate_friction_of(fabric), std::move(memory), first));
  }
  return forces;
}

}  // namespace drape
