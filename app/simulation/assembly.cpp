#include "app/simulation/assembly.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "app/pattern/pattern_read.h"
#include "app/pattern/remarks.h"
#include "app/simulation/cloth_model.h"
#include "mesh/obj/obj.h"
#include "mesh/pattern/flat_pattern.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/face_contact_force.h"

namespace drape {
namespace {

// As drape triangulate writes it and reads it again.
TriangleMesh cut_pattern(const ClothEntry& entry, Names& messages) try {
  Names notes;
  PatternMesh cut = triangulate(read_pattern(entry.mesh, notes), entry.pattern);
  for (const std::string& note : notes) messages.push_back("note: " + note);
  for (std::string& line : remarks(cut, entry.pattern.min_angle, entry.mesh.string()))
    messages.push_back(std::move(line));
  return std::move(cut.mesh);
} catch (const InputError& error) {
  throw InputError(entry.where + ": mesh: " + error.what());
}

// Texture coordinates are often without a length: the rest shape has then nothing to do with the mesh.
void warn_of_scale(const ClothEntry& entry, const Cloth& cloth, Names& messages) {
  if (!entry.rest_is_flat) return;
  double area = 0, flat = 0;
  for (const Triangle& t : cloth.mesh.triangles) area += triangle_area(cloth.mesh, t);
  for (const Triangle& t : cloth.rest.triangles) flat += triangle_area(cloth.rest, t);
  if (flat > 0.5 * area && flat < 2 * area) return;
  messages.push_back("warning: cloth " + entry.name + ": rests with an area of " + rounded(flat, 3) +
                     " m^2 by its uv, and its mesh has " + rounded(area, 3) +
                     " m^2: was another uv_scale meant? (lengths would agree with " +
                     rounded(entry.uv_scale * std::sqrt(area / flat), 4) + " m)");
}

// As the file has it, its panels placed; the rest shape is the flat pattern, or what the file has.
Cloth load_cloth(const ClothEntry& entry, Names& messages) {
  require_file(entry.mesh, entry.where);
  Cloth cloth;
  cloth.name = entry.name;
  cloth.mesh = placed(is_pattern(entry.mesh) ? cut_pattern(entry, messages) : read_obj(entry.mesh),
                      {.scale = entry.placement.scale}, entry.mesh.string());
  try {
    cloth.rest =
        entry.rest_is_flat ? flat_pattern(cloth.mesh, entry.uv_scale * entry.placement.scale) : cloth.mesh;
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + entry.mesh.string() + ": " + error.what());
  }
  warn_of_scale(entry, cloth, messages);
  place_panels(entry, cloth.mesh, messages);
  const Placement rest_of_it{.rotation = entry.placement.rotation, .translate = entry.placement.translate};
  cloth.mesh = placed(std::move(cloth.mesh), rest_of_it, entry.mesh.string());
  cloth.report = examine(cloth.mesh);
  add_messages(cloth.report, entry.mesh.string(), messages);
  for (OpenSeam& seam : open_seams(entry, cloth.mesh, cloth.rest, messages))
    cloth.seams.push_back({std::move(seam), nullptr});
  return cloth;
}

// The cloth's triangles between its particles, numbered from its first.
TriangleMesh between_particles(const Cloth& cloth) {
  TriangleMesh mesh = cloth.mesh;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = cloth.embedding.particle(v) - cloth.first_particle;
  mesh.positions.resize(static_cast<std::size_t>(cloth.end_particle - cloth.first_particle));
  return mesh;
}

// Momentum of the particles that become one, number[i] being what particle i becomes and masses [kg] those
// that they have then. What is pinned stays where its first pin holds it.
State merged_state(const Simulation& simulation, const std::vector<double>& masses,
                   const std::vector<int>& number) {
  const State& state = simulation.state;
  const auto count = static_cast<Eigen::Index>(masses.size());
  State merged{state.time, VecX::Zero(3 * count), VecX::Zero(3 * count)};
  std::vector<int> parts(masses.size(), 0), pinned(masses.size(), -1);
  for (int n : number) ++parts[static_cast<std::size_t>(n)];
  for (int i : simulation.constraints->pinned()) {
    int& first = pinned[static_cast<std::size_t>(number[static_cast<std::size_t>(i)])];
    if (first < 0) first = i;
  }
  for (int i = 0; i < state.particles(); ++i) {
    const int to = number[static_cast<std::size_t>(i)];
    const auto n = static_cast<std::size_t>(to);
    double share = 1;
    if (pinned[n] >= 0)
      share = pinned[n] == i ? 1 : 0;
    else if (parts[n] > 1)
      share = masses[n] > 0 ? simulation.system->masses()[static_cast<std::size_t>(i)] / masses[n]
                            : 1.0 / parts[n];
    merged.x.segment<3>(3 * to) += share * state.x.segment<3>(3 * i);
    merged.v.segment<3>(3 * to) += share * state.v.segment<3>(3 * i);
  }
  return merged;
}

}  // namespace

Particles load_particles(const Scene& scene, Simulation& simulation) {
  Particles particles;
  std::vector<double>& masses = particles.masses;
  std::vector<Vec3> positions;
  for (const ClothEntry& entry : scene.cloths) {
    Cloth cloth = load_cloth(entry, simulation.messages);
    const std::vector<double> own = cloth_masses(entry, cloth.mesh, cloth.rest);
    masses.insert(masses.end(), own.begin(), own.end());
    cloth.first_particle = static_cast<int>(positions.size());
    cloth.embedding = Embedding::each(cloth.first_particle, cloth.mesh.vertex_count());
    positions.insert(positions.end(), cloth.mesh.positions.begin(), cloth.mesh.positions.end());
    cloth.end_particle = static_cast<int>(positions.size());
    simulation.cloths.push_back(std::move(cloth));
  }
  for (const SoftEntry& entry : scene.softs) {
    SoftBody soft = make_soft_body(entry, static_cast<int>(positions.size()), simulation.messages);
    masses.insert(masses.end(), soft.masses.begin(), soft.masses.end());
    positions.insert(positions.end(), soft.positions.begin(), soft.positions.end());
    particles.soft_faces.insert(particles.soft_faces.end(), soft.faces.begin(), soft.faces.end());
    simulation.cloths.push_back(std::move(soft.cloth));
  }
  simulation.state.x = stacked(positions);
  simulation.state.v = VecX::Zero(simulation.state.x.size());
  return particles;
}

void add_faces(const Scene& scene, const Particles& particles, Simulation& simulation) {
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
  simulation.constraints->add_faces(particles.soft_faces);
}

void assemble(Simulation& simulation, std::vector<double> masses, Names& messages) {
  const Scene& scene = *simulation.scene;
  std::vector<std::unique_ptr<Force>> forces;
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    Cloth& cloth = simulation.cloths[k];
    const ClothEntry& entry = scene.cloths[k];
    const Connections connections = cloth_connections(entry, between_particles(cloth), cloth.rest, messages);
    cloth.edges.clear();
    for (const StretchConnection& s : connections.stretch)
      if (s.L > 0) cloth.edges.push_back({cloth.first_particle + s.i, cloth.first_particle + s.j, s.L});
    for (auto& force : forces_of(connections, entry.fabric, cloth.first_particle))
      forces.push_back(std::move(force));
    for (Cloth::Stitched& open : cloth.seams) {
      std::unique_ptr<Force> force = stitches(open.seam, cloth.embedding, simulation.state.time);
      open.force = force.get();
      if (force) forces.push_back(std::move(force));
    }
  }
  for (std::size_t k = scene.cloths.size(); k < simulation.cloths.size(); ++k)
    for (auto& force : simulation.cloths[k].springs(simulation.cloths[k].first_particle))
      forces.push_back(std::move(force));
  simulation.system = std::make_unique<System>(std::move(masses));
  simulation.system->add(Gravity{scene.simulation.gravity});
  simulation.system->add(std::move(forces));
  if (!simulation.constraints->faces().all().empty())
    simulation.system->add(face_contact_force(*simulation.constraints));
}

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
  std::vector<double> masses(1 + static_cast<std::size_t>(*std::max_element(number.begin(), number.end())),
                             0.0);
  for (std::size_t i = 0; i < number.size(); ++i)
    masses[static_cast<std::size_t>(number[i])] += simulation.system->masses()[i];
  State fewer = merged_state(simulation, masses, number);
  simulation.outgrown.push_back(std::exchange(simulation.state, std::move(fewer)));
  for (Cloth& cloth : simulation.cloths) cloth.renumber(number);
  simulation.constraints->merge(number);
  Names said_before;
  assemble(simulation, std::move(masses), said_before);
  return true;
}

void Cloth::renumber(const std::vector<int>& number) {
  embedding.renumber(number);
  for (RestEdge& e : edges) {
    e.i = number[static_cast<std::size_t>(e.i)];
    e.j = number[static_cast<std::size_t>(e.j)];
  }
  int low = number[static_cast<std::size_t>(first_particle)], high = low;
  for (int i = first_particle; i < end_particle; ++i) {
    low = std::min(low, number[static_cast<std::size_t>(i)]);
    high = std::max(high, number[static_cast<std::size_t>(i)]);
  }
  first_particle = low;
  end_particle = high + 1;
}

}  // namespace drape
