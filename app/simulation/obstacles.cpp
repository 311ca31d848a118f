#include "app/simulation/obstacles.h"

#include "app/scene/body_frames.h"
#include "app/scene/level_set_cache.h"
#include "app/scene/load_mesh.h"
#include "mesh/base/errors.h"
#include "mesh/base/match.h"

namespace drape::app {
namespace {

Shape load_body(const ObstacleEntry& entry, Body& body, Names& messages) {
  const std::string name = entry.mesh.string();
  const TriangleMesh mesh = load_mesh(entry.mesh, entry.where, entry.placement, body.report, messages);
  const auto surface = std::make_shared<SurfaceDistance>(mesh);
  if (!surface->closed())
    messages.push_back(
        "warning: " + name +
        ": the body is not closed: it has no inside and is treated as a thick surface, from which the "
        "cloth keeps its margin on either side");
  if (surface->inside_out())
    messages.push_back("note: " + name + ": the body's triangles are wound inside out; it is turned round");
  if (entry.frames.files.empty()) return MeshBody(surface);
  Shape shape = DeformingBody{surface, load_frames(entry, mesh)};
  move(shape, 0, 0);  // where it starts
  return shape;
}

// The body that reacts. What the scene does not give is that of the solid of uniform density.
RigidBody rigid_body(const ObstacleEntry& entry, const Obstacle& obstacle, const Vec3& gravity) {
  const RigidBodyEntry& given = *entry.rigid;
  RigidBody body{given.mass, Mat3::Identity(), given.centre, given.velocity, given.spin, gravity};
  const auto solid = uniform_solid(obstacle.shape, given.mass);
  if (solid) {
    body.centre = solid->centre;
    body.inertia = solid->inertia;
  } else if (deforming(obstacle.shape)) {
    if (!given.inertia)
      throw InputError(
          entry.where + ": mass: " + entry.mesh.string() +
          ": a mesh with frames changes its moments of inertia; give its `inertia`, or leave the "
          "mass out");
  } else {
    throw InputError(
        entry.where + ": mass: " + entry.mesh.string() +
        ": the mesh is not closed: it has no inside that could weigh; close it, or leave the mass out");
  }
  if (given.inertia) body.inertia = given.axes * given.inertia->asDiagonal() * given.axes.transpose();
  return body;
}

// The mesh is scaled before the grid is made, and the grid turned and moved: one is kept for all placements.
LevelSetBody load_level_set(const ObstacleEntry& entry, bool keep, Body& body, Names& messages) {
  const std::string name = entry.mesh.string();
  const double scale = entry.placement.scale, margin = entry.obstacle.margin;
  require_file(entry.mesh, entry.where);
  const auto grid = [&] {
    if (is_vdb(entry.mesh)) {
      LevelSet read = LevelSet::read(entry.mesh, scale);
      if (margin + read.voxel() > read.band())
        throw InputError(entry.where + ": a margin of " + rounded(1000 * margin, 3) +
                         " mm is too wide for the " + rounded(1000 * read.band(), 3) +
                         " mm round the surface that " + name + " holds: name the OBJ file instead");
      body.report.lower = read.lower(), body.report.upper = read.upper();
      return read;
    }
    const TriangleMesh mesh = load_mesh(entry.mesh, entry.where, {.scale = scale}, body.report, messages);
    return cached_level_set(mesh, {entry.mesh, scale, entry.voxel, margin, keep}, messages);
  }();
  body.level_set = described(grid);
  warn_of_error(grid, name, messages);
  return std::make_shared<const LevelSet>(grid.moved(entry.placement.rotation, entry.placement.translate));
}

Shape loaded(const ObstacleEntry& entry, bool keep_level_sets, Body& body, Names& messages) {
  return std::visit(Match{[&](const MeshBody&) { return load_body(entry, body, messages); },
                          [&](const LevelSetBody&) {
                            return Shape(load_level_set(entry, keep_level_sets, body, messages));
                          },
                          [](const auto& whole) { return Shape(whole); }},  // nothing of it is in a file
                    entry.obstacle.shape);
}

// A built-in shape beyond all sense is a wrong unit, and nothing that could be written as floats.
void check_extent(const ObstacleEntry& entry, const Shape& shape) {
  for (const Vec3& x : mesh_of(shape).positions)
    if (!(x.cwiseAbs().maxCoeff() <= largest_size))
      throw InputError(entry.where + ": the " + std::string(name(shape)) + " reaches " +
                       rounded(x.cwiseAbs().maxCoeff(), 3) + " m from the origin, more than " +
                       rounded(largest_size, 3) + " m; check the units");
}

}  // namespace

void add_obstacles(const Scene& scene, bool keep_level_sets, Simulation& simulation) {
  for (const ObstacleEntry& entry : scene.obstacles) {
    Obstacle obstacle = entry.obstacle;
    Body body;
    body.name = entry.name;
    obstacle.shape = loaded(entry, keep_level_sets, body, simulation.messages);
    check_extent(entry, obstacle.shape);
    if (entry.rigid) obstacle.rigid = rigid_body(entry, obstacle, scene.simulation.gravity);
    try {
      simulation.constraints->add(std::move(obstacle));
    } catch (const InputError& error) {
      throw InputError(entry.where + ": " + error.what());
    }
    simulation.bodies.push_back(std::move(body));
  }
}

}  // namespace drape::app
