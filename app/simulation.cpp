#include "app/simulation.h"

#include <algorithm>
#include <numeric>

#include "app/body_frames.h"
#include "app/cloth_model.h"
#include "app/level_set_cache.h"
#include "app/soft_body.h"
#include "app/warnings.h"
#include "mesh/flat_pattern.h"
#include "mesh/obj.h"
#include "mesh/solid.h"
#include "solver/face_contact_force.h"

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

// As the file has it, its panels placed; the rest shape is the flat pattern, or what the file has.
Cloth load_cloth(const ClothEntry& entry, Names& messages) {
  require_file(entry.mesh, entry.where);
  Cloth cloth;
  cloth.name = entry.name;
  cloth.mesh = placed(read_obj(entry.mesh), {.scale = entry.placement.scale}, entry.mesh.string());
  try {
    cloth.rest = entry.rest_is_flat ? flat_pattern(cloth.mesh, entry.uv_scale) : cloth.mesh;
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + entry.mesh.string() + ": " + error.what());
  }
  place_panels(entry, cloth.mesh);
  const Placement rest_of_it{.rotation = entry.placement.rotation, .translate = entry.placement.translate};
  cloth.mesh = placed(std::move(cloth.mesh), rest_of_it, entry.mesh.string());
  cloth.report = examine(cloth.mesh);
  add_messages(cloth.report, entry.mesh.string(), messages);
  for (OpenSeam& seam : open_seams(entry, cloth.mesh, cloth.rest, messages))
    cloth.seams.push_back({std::move(seam), nullptr});
  return cloth;
}

void load_cloths(const Scene& scene, Simulation& simulation) {
  int particles = 0;
  for (const ClothEntry& entry : scene.cloths) {
    Cloth cloth = load_cloth(entry, simulation.messages);
    cloth.first_particle = particles;
    cloth.embedding = Embedding::each(particles, cloth.mesh.vertex_count());
    cloth.end_particle = particles += cloth.mesh.vertex_count();
    simulation.cloths.push_back(std::move(cloth));
  }
  for (const SoftEntry& entry : scene.softs) {
    simulation.cloths.push_back(make_soft_body(entry, particles, simulation.messages));
    particles = simulation.cloths.back().end_particle;
  }
  simulation.state.x.resize(3 * particles);
  simulation.state.v = VecX::Zero(3 * particles);
  for (const Cloth& cloth : simulation.cloths)
    simulation.state.x.segment(3 * cloth.first_particle, 3 * (cloth.end_particle - cloth.first_particle)) =
        stacked(cloth.soft ? cloth.soft->positions : cloth.mesh.positions);
}

// The cloth's triangles between its particles, numbered from its first.
TriangleMesh between_particles(const Cloth& cloth) {
  TriangleMesh mesh = cloth.mesh;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = cloth.embedding.particle(v) - cloth.first_particle;
  mesh.positions.resize(static_cast<std::size_t>(cloth.end_particle - cloth.first_particle));
  return mesh;
}

// The system of all that is simulated, as it is sewn by now.
void assemble(Simulation& simulation, Names& messages) {
  const Scene& scene = *simulation.scene;
  std::vector<double> all_masses;
  std::vector<std::unique_ptr<Force>> forces;
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    Cloth& cloth = simulation.cloths[k];
    const ClothEntry& entry = scene.cloths[k];
    const ClothModel model = cloth_model(entry, between_particles(cloth), cloth.rest, messages);
    all_masses.insert(all_masses.end(), model.masses.begin(), model.masses.end());
    cloth.edges.clear();
    for (const StretchConnection& s : model.connections.stretch)
      if (s.L > 0) cloth.edges.push_back({cloth.first_particle + s.i, cloth.first_particle + s.j, s.L});
    for (auto& force : forces_of(model.connections, entry.fabric, cloth.first_particle))
      forces.push_back(std::move(force));
    for (Cloth::Stitched& open : cloth.seams) {
      std::unique_ptr<Force> force = stitches(open.seam, cloth.embedding, simulation.state.time);
      open.force = force.get();
      if (force) forces.push_back(std::move(force));
    }
  }
  for (std::size_t k = 0; k < scene.softs.size(); ++k) {
    const Cloth& body = simulation.cloths[scene.cloths.size() + k];
    const std::vector<double> own = masses_of(scene.softs[k], *body.soft);
    all_masses.insert(all_masses.end(), own.begin(), own.end());
    for (auto& force : soft_body(body.soft->lattice, scene.softs[k].material, body.first_particle))
      forces.push_back(std::move(force));
  }
  simulation.system = std::make_unique<System>(std::move(all_masses));
  simulation.system->add(Gravity{scene.simulation.gravity});
  simulation.system->add(std::move(forces));
  if (!simulation.constraints->faces().all().empty())
    simulation.system->add(face_contact_force(*simulation.constraints));
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
void add_faces(const Scene& scene, Simulation& simulation) {
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
  for (std::size_t k = 0; k < scene.softs.size(); ++k)
    simulation.constraints->add_faces(faces_of(scene.softs[k], simulation.cloths[scene.cloths.size() + k]));
}

// Mass and momentum of the particles that become one, number[i] being what particle i becomes.
State merged_state(const State& state, const std::vector<double>& masses, const std::vector<int>& number) {
  const int count = 1 + *std::max_element(number.begin(), number.end());
  State merged{state.time, VecX::Zero(3 * count), VecX::Zero(3 * count)};
  std::vector<double> weight(static_cast<std::size_t>(count), 0.0);
  for (std::size_t i = 0; i < number.size(); ++i) weight[static_cast<std::size_t>(number[i])] += masses[i];
  std::vector<int> parts(weight.size(), 0);
  for (int n : number) ++parts[static_cast<std::size_t>(n)];
  for (std::size_t i = 0; i < number.size(); ++i) {
    const auto n = static_cast<std::size_t>(number[i]);
    const double share = parts[n] == 1 ? 1 : weight[n] > 0 ? masses[i] / weight[n] : 1.0 / parts[n];
    merged.x.segment<3>(3 * number[i]) += share * state.x.segment<3>(3 * static_cast<Eigen::Index>(i));
    merged.v.segment<3>(3 * number[i]) += share * state.v.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  return merged;
}

// Seams that have closed: their particles become one, and the cloth one piece. False: there were none.
bool merge_closed_seams(Simulation& simulation) {
  std::vector<int> number(static_cast<std::size_t>(simulation.state.particles()));
  std::iota(number.begin(), number.end(), 0);
  bool any = false;
  for (Cloth& cloth : simulation.cloths) {
    std::vector<const OpenSeam*> closed;
    for (const Cloth::Stitched& open : cloth.seams)
      if (open.seam.closed(cloth.embedding, simulation.state)) closed.push_back(&open.seam);
    if (closed.empty()) continue;
    any = true;
    number = merged(number, closed, cloth.embedding);
    std::erase_if(cloth.seams, [&](const Cloth::Stitched& open) {
      return open.seam.closed(cloth.embedding, simulation.state);
    });
  }
  if (!any) return false;
  simulation.state = merged_state(simulation.state, simulation.system->masses(), number);
  for (Cloth& cloth : simulation.cloths) cloth.renumber(number);
  simulation.constraints->merge(number);
  Names said_before;
  assemble(simulation, said_before);
  return true;
}

}  // namespace

void Cloth::renumber(const std::vector<int>& number) {
  embedding.renumber(number);
  int low = number[static_cast<std::size_t>(first_particle)], high = low;
  for (int i = first_particle; i < end_particle; ++i) {
    low = std::min(low, number[static_cast<std::size_t>(i)]);
    high = std::max(high, number[static_cast<std::size_t>(i)]);
  }
  first_particle = low;
  end_particle = high + 1;
}

StepReport Simulation::advance(double h) {
  bool open = false;
  for (Cloth& cloth : cloths)
    for (Cloth::Stitched& stitched : cloth.seams) {
      if (stitched.force) close_until(*stitched.force, stitched.seam, state.time + h);
      open = true;
    }
  const StepReport report = integrator->advance(state, h);
  if (open && report.done && merge_closed_seams(*this)) integrator = make_integrator(*system, *constraints);
  return report;
}

void Simulation::use(std::function<std::unique_ptr<Integrator>(System&, Constraints&)> make) {
  make_integrator = std::move(make);
  integrator = make_integrator(*system, *constraints);
}

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
  simulation.scene = std::make_shared<const Scene>(scene);
  simulation.constraints = std::make_unique<Constraints>(scene.simulation.contact);
  load_cloths(scene, simulation);
  add_obstacles(scene, keep_level_sets, simulation);
  add_faces(scene, simulation);
  add_pins(scene, simulation);  // some of them to bodies
  assemble(simulation, simulation.messages);
  add_warnings(scene, simulation);
  simulation.use([options = scene.simulation](System& system, Constraints& constraints) {
    return make_integrator(options.integrator, system, constraints, make_linear_solver(options.linear_solver),
                           options.step);
  });
  return simulation;
}

}  // namespace drape
