#include "app/simulation/soft_body.h"

#include <algorithm>

#include "app/base/free_memory.h"
#include "mesh/base/errors.h"
#include "mesh/lattice/solid.h"
#include "solver/forces/soft.h"

namespace drape {
namespace {

// What a particle takes, with its springs, its blocks of the matrix and of a preconditioner, and what a
// corner of the box of cells takes while it is filled. Measured: 4.5 kB of 216 000 particles, 6.2 of 27 000.
constexpr double bytes_per_particle = 6000, bytes_per_corner = 6;

void require_memory(double particles, double corners) {
  const double needed = particles * bytes_per_particle + corners * bytes_per_corner;
  const std::optional<double> there = free_memory();
  constexpr double most = 1e8;  // particle numbers, three coordinates each, and springs are counted in int
  if (particles < most && !(there && needed > *there)) return;
  throw InputError(
      "a lattice of about " + rounded(particles, 2) + " particles needs some " + rounded(needed / 1e9, 2) +
      " GB" + (there ? ", and " + rounded(*there / 1e9, 2) + " GB are free" : "") + "; take a wider spacing");
}

Lattice box_of(const SoftEntry& entry) {
  double count = 1;
  for (int n : entry.particles) count *= n;
  require_memory(count, count);
  return box_lattice(entry.particles, entry.placement.scale * entry.spacing);
}

Lattice lattice_of(const SoftEntry& entry, TriangleMesh& mesh, Names& messages) {
  MeshReport report;
  if (!entry.mesh.empty())
    mesh = load_mesh(entry.mesh, entry.where, {.scale = entry.placement.scale}, report, messages);
  try {
    if (entry.mesh.empty()) return box_of(entry);
    const LatticeSize size = lattice_size(mesh, entry.spacing[0]);
    require_memory(size.particles, size.corners);
    return filled_lattice(mesh, entry.spacing[0], entry.mesh.string());
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + error.what());
  }
}

void add_edges(const std::vector<LatticePair>& pairs, const std::vector<Vec3>& positions, Cloth& cloth) {
  for (const LatticePair& p : pairs)
    cloth.edges.push_back(
        {cloth.first_particle + p.i, cloth.first_particle + p.j,
         (positions[static_cast<std::size_t>(p.i)] - positions[static_cast<std::size_t>(p.j)]).norm()});
}

}  // namespace

SoftBody make_soft_body(const SoftEntry& entry, int first_particle, Names& messages) {
  SoftBody body;
  Cloth& cloth = body.cloth;
  cloth.name = entry.name;
  const auto kept = std::make_shared<const Lattice>(lattice_of(entry, cloth.mesh, messages));
  const Lattice& lattice = *kept;
  std::vector<int> on_surface;
  const TriangleMesh surface = surface_of(lattice, on_surface);
  std::optional<double> volume;
  if (entry.mesh.empty()) {
    cloth.mesh = surface;
    for (int p : on_surface) cloth.embedding.add_vertex(first_particle + p);
  } else {
    cloth.embedding = embedding_in(lattice, cloth.mesh.positions, first_particle);
    volume = solid_of(cloth.mesh).volume;
  }
  try {
    body.masses = masses(lattice, entry.material, volume);
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + error.what());
  }
  const Placement placement{.rotation = entry.placement.rotation, .translate = entry.placement.translate};
  cloth.mesh = placed(std::move(cloth.mesh), placement, entry.name);
  cloth.report = examine(cloth.mesh);
  TriangleMesh points;  // the particles alone
  points.positions = lattice.positions;
  body.positions = placed(std::move(points), placement, entry.name).positions;
  cloth.first_particle = first_particle;
  cloth.end_particle = first_particle + lattice.particle_count();
  cloth.springs = [kept, material = entry.material](int first) { return soft_body(*kept, material, first); };
  cloth.soft = LatticeCounts{static_cast<int>(lattice.structural.size()),
                             static_cast<int>(lattice.shear.size()), static_cast<int>(lattice.bend.size())};
  for (const auto* pairs : {&lattice.structural, &lattice.shear, &lattice.bend})
    add_edges(*pairs, lattice.positions, cloth);
  const double stiffness =
      entry.material.young ? *entry.material.young * lattice.spacing[0] : entry.material.structural;
  for (const Triangle& t : surface.triangles) {
    const auto particle = [&](std::size_t k) {
      return first_particle + on_surface[static_cast<std::size_t>(t[k])];
    };
    body.faces.push_back({{particle(0), particle(1), particle(2)}, stiffness});
  }
  return body;
}

std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x) {
  std::vector<int> particles;
  if (cloth.soft && std::holds_alternative<PinBox>(rule)) {
    TriangleMesh points;  // the particles themselves
    points.positions =
        unstacked(x.segment(3 * cloth.first_particle, 3 * (cloth.end_particle - cloth.first_particle)));
    particles = select(rule, points);
    for (int& p : particles) p += cloth.first_particle;
    return particles;
  }
  for (int v : select(rule, cloth.mesh))
    for (const Embedding::Share& share : cloth.embedding.shares(v)) particles.push_back(share.particle);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

}  // namespace drape
