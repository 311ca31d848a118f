#include "app/simulation.h"

#include <algorithm>

#include "app/body_frames.h"
#include "app/level_set_cache.h"
#include "app/soft_body.h"
#include "app/warnings.h"
#include "mesh/obj.h"
#include "mesh/solid.h"
#include "solver/face_contact_force.h"
#include "solver/noh_jung.h"

namespace drape {
namespace {

void require_file(const std::filesystem::path& path, const std::string& where) {
  const bool in_a_file = where.find(':') != where.npos;
  if (in_a_file && !std::filesystem::exists(path))
    throw InputError(where + ": mesh: " + path.string() + ": no such file");
}

// One mesh at a time: read, placed, looked over.
TriangleMesh load(const std::filesystem::path& path, const std::string& where, const Placement& placement,
                  MeshReport& report, Names& messages) {
  require_file(path, where);
  TriangleMesh mesh = placed(read_obj(path), placement, path.string());
  report = examine(mesh);
  add_messages(report, path.string(), messages);
  return mesh;
}

void add_cloths(const Scene& scene, std::vector<SoftBody>& softs, Simulation& simulation) {
  std::vector<double> all_masses;
  for (const ClothEntry& entry : scene.cloths) {
    Cloth cloth;
    cloth.name = entry.name;
    cloth.first_particle = static_cast<int>(all_masses.size());
    cloth.mesh = load(entry.mesh, entry.where, entry.placement, cloth.report, simulation.messages);
    const std::vector<double> own = masses(cloth.mesh, entry.fabric);
    all_masses.insert(all_masses.end(), own.begin(), own.end());
    cloth.end_particle = static_cast<int>(all_masses.size());
    cloth.embedding = Embedding::each(cloth.first_particle, cloth.mesh.vertex_count());
    simulation.cloths.push_back(std::move(cloth));
  }
  for (const SoftEntry& entry : scene.softs) {
    softs.push_back(make_soft_body(entry, static_cast<int>(all_masses.size()), simulation.messages));
    const SoftBody& soft = softs.back();
    all_masses.insert(all_masses.end(), soft.masses.begin(), soft.masses.end());
    simulation.cloths.push_back(soft.cloth);
  }
  simulation.system = std::make_unique<System>(std::move(all_masses));
  simulation.system->add(Gravity{scene.simulation.gravity});
  simulation.state.x.resize(3 * simulation.system->particles());
  simulation.state.v = VecX::Zero(3 * simulation.system->particles());
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    Cloth& cloth = simulation.cloths[k];
    const ClothEntry& entry = scene.cloths[k];
    const Connections connections = noh_jung_connections(cloth.mesh, cloth.mesh, entry.fabric);
    for (const StretchConnection& s : connections.stretch)
      if (s.L > 0) cloth.edges.push_back({cloth.first_particle + s.i, cloth.first_particle + s.j, s.L});
    warn_if_limp(entry, limp_below(connections, entry.fabric), simulation.messages);
    simulation.system->add(forces_of(connections, entry.fabric, cloth.first_particle));
    simulation.state.x.segment(3 * cloth.first_particle, 3 * cloth.mesh.vertex_count()) =
        stacked(cloth.mesh.positions);
  }
  for (SoftBody& soft : softs) {
    simulation.system->add(std::move(soft.forces));
    const VecX x = stacked(soft.positions);
    simulation.state.x.segment(3 * soft.cloth.first_particle, x.size()) = x;
  }
}

void pin_down(const PinEntry& pin, const Cloth& cloth, const Scene& scene, Simulation& simulation) {
  const std::vector<int> particles = pinned_particles(pin.rule, cloth, simulation.state.x);
  Constraints& constraints = *simulation.constraints;
  if (pin.motion) return constraints.pin_along(particles, *pin.motion, simulation.state.x);
  if (pin.follow.empty()) return constraints.pin(particles);
  const auto body = std::find_if(scene.obstacles.begin(), scene.obstacles.end(),
                                 [&](const ObstacleEntry& o) { return o.name == pin.follow; });
  constraints.pin_to_body(particles, static_cast<int>(body - scene.obstacles.begin()), simulation.state.x);
}

void add_pins(const Scene& scene, Simulation& simulation) {
  for (std::size_t k = 0; k < simulation.cloths.size(); ++k) {
    const Cloth& cloth = simulation.cloths[k];
    for (const PinEntry& pin : scene.pins_of(k)) {
      try {
        pin_down(pin, cloth, scene, simulation);
      } catch (const InputError& error) {
        throw InputError(pin.where + ": " + error.what());
      }
    }
  }
}

Shape load_body(const ObstacleEntry& entry, Body& body, Names& messages) {
  const std::string name = entry.mesh.string();
  const TriangleMesh mesh = load(entry.mesh, entry.where, entry.placement, body.report, messages);
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

// The body that reacts. What the scene leaves to a mesh: the solid of uniform density within it.
RigidBody rigid_body(const ObstacleEntry& entry, const Obstacle& obstacle, const Vec3& gravity) {
  const RigidBodyEntry& given = *entry.rigid;
  RigidBody body{given.mass, Mat3::Identity(), given.centre, given.velocity, given.spin, gravity};
  if (const auto* mesh = std::get_if<MeshBody>(&obstacle.shape)) {
    if (!(*mesh)->closed())
      throw InputError(
          entry.where + ": mass: " + entry.mesh.string() +
          ": the mesh is not closed: it has no inside that could weigh; close it, or leave the mass out");
    const Solid solid = solid_of((*mesh)->mesh());
    body.centre = solid.centre;
    body.inertia = given.mass / solid.volume * solid.inertia;
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
    const TriangleMesh mesh = load(entry.mesh, entry.where, {.scale = scale}, body.report, messages);
    return cached_level_set(mesh, {entry.mesh, scale, entry.voxel, margin, keep}, messages);
  }();
  body.level_set = described(grid);
  warn_of_error(grid, name, messages);
  return std::make_shared<const LevelSet>(grid.moved(entry.placement.rotation, entry.placement.translate));
}

void add_obstacles(const Scene& scene, bool keep_level_sets, Simulation& simulation) {
  for (const ObstacleEntry& entry : scene.obstacles) {
    Obstacle obstacle = entry.obstacle;
    Body body;
    body.name = entry.name;
    if (std::holds_alternative<MeshBody>(obstacle.shape))
      obstacle.shape = load_body(entry, body, simulation.messages);
    if (std::holds_alternative<LevelSetBody>(obstacle.shape))
      obstacle.shape = load_level_set(entry, keep_level_sets, body, simulation.messages);
    if (entry.rigid) obstacle.rigid = rigid_body(entry, obstacle, scene.simulation.gravity);
    try {
      simulation.constraints->add(std::move(obstacle));
    } catch (const InputError& error) {
      throw InputError(entry.where + ": " + error.what());
    }
    simulation.bodies.push_back(std::move(body));
  }
}

// Corners and rims of bodies are kept off the inside of triangles, too.
void add_faces(const Scene& scene, const std::vector<SoftBody>& softs, Simulation& simulation) {
  if (scene.obstacles.empty()) return;
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    const Cloth& cloth = simulation.cloths[k];
    const Fabric& fabric = scene.cloths[k].fabric;
    std::vector<ClothFace> faces;
    for (const Triangle& t : cloth.mesh.triangles)
      faces.push_back(
          {{cloth.embedding.particle(t[0]), cloth.embedding.particle(t[1]), cloth.embedding.particle(t[2])},
           fabric.stretch_spring.value_or(fabric.stretch)});
    simulation.constraints->add_faces(faces);
  }
  for (const SoftBody& soft : softs) simulation.constraints->add_faces(soft.faces);
  simulation.system->add(face_contact_force(*simulation.constraints));
}

}  // namespace

const Cloth& Simulation::cloth_of(int particle) const {
  const auto after =
      std::find_if(cloths.begin(), cloths.end(), [&](const Cloth& c) { return particle < c.end_particle; });
  return after == cloths.end() ? cloths.back() : *after;
}

TriangleMesh load_mesh(const std::filesystem::path& path, const std::string& where,
                       const Placement& placement, MeshReport& report, Names& messages) {
  return load(path, where, placement, report, messages);
}

TriangleMesh placed(TriangleMesh mesh, const Placement& placement, const std::string& name) {
  for (Vec3& x : mesh.positions) {
    x = placement.rotation * (placement.scale * x) + placement.translate;
    if (!x.allFinite())
      throw InputError(name + ": scale and translate put a vertex out of the range of numbers");
  }
  return mesh;
}

void add_messages(const MeshReport& report, const std::string& name, Names& messages) {
  for (const Defect& defect : report.defects) {
    const std::string line = format(defect);
    const std::size_t colon = line.find(": ") + 2;
    if (defect.severity == Severity::refusal) throw InputError(name + ": " + line.substr(colon));
    const bool says_where = line.compare(colon, name.size() + 1, name + ":") == 0;  // what the reader noted
    messages.push_back(line.substr(0, colon) + (says_where ? "" : name + ": ") + line.substr(colon));
  }
}

Simulation make_simulation(const Scene& scene, bool keep_level_sets) {
  Simulation simulation;
  simulation.constraints = std::make_unique<Constraints>(scene.simulation.contact);
  std::vector<SoftBody> softs;
  add_cloths(scene, softs, simulation);
  add_obstacles(scene, keep_level_sets, simulation);
  add_faces(scene, softs, simulation);
  add_pins(scene, simulation);  // some of them to bodies
  add_warnings(scene, simulation);
  simulation.integrator =
      make_integrator(scene.simulation.integrator, *simulation.system, *simulation.constraints,
                      make_linear_solver(scene.simulation.linear_solver), scene.simulation.step);
  return simulation;
}

}  // namespace drape
