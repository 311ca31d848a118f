#include "app/soft_body.h"

#include <algorithm>

#include "app/free_memory.h"
#include "mesh/obj.h"
#include "mesh/solid.h"
#include "solver/soft.h"

namespace drape {
namespace {

// What a particle takes, with its springs, its blocks of the matrix and of a preconditioner, and what a
// corner of the box of cells takes while it is filled. Measured: app/README.md.
constexpr double bytes_per_particle = 6000, bytes_per_corner = 6;

void require_memory(double particles, double corners, const std::string& where) {
  const double needed = particles * bytes_per_particle + corners * bytes_per_corner;
  const std::optional<double> there = free_memory();
  constexpr double most = 1e8;  // particle numbers, three coordinates each, and springs are counted in int
  if (particles < most && !(there && needed > *there)) return;
  throw InputError(where + ": a lattice of about " + rounded(particles, 2) + " particles needs some " +
                   rounded(needed / 1e9, 2) + " GB" +
                   (there ? ", and " + rounded(*there / 1e9, 2) + " GB are free" : "") +
                   "; take a wider spacing");
}

Lattice lattice_of(const SoftEntry& entry, TriangleMesh& mesh, Names& messages) {
  MeshReport report;
  if (entry.mesh.empty()) {
    double count = 1;
    for (int n : entry.particles) count *= n;
    require_memory(count, count, entry.where);
    return box_lattice(entry.particles, entry.placement.scale * entry.spacing);
  }
  const std::string name = entry.mesh.string();
  mesh = load_mesh(entry.mesh, entry.where, {.scale = entry.placement.scale}, report, messages);
  const LatticeSize size = lattice_size(mesh, entry.spacing[0]);
  require_memory(size.particles, size.corners, entry.where);
  return filled_lattice(mesh, entry.spacing[0], name);
}

void add_edges(const std::vector<LatticePair>& pairs, const std::vector<Vec3>& positions, Cloth& cloth) {
  for (const LatticePair& p : pairs)
    cloth.edges.push_back(
        {cloth.first_particle + p.i, cloth.first_particle + p.j,
         (positions[static_cast<std::size_t>(p.i)] - positions[static_cast<std::size_t>(p.j)]).norm()});
}

}  // namespace

Cloth make_soft_body(const SoftEntry& entry, int first_particle, Names& messages) {
  Cloth body;
  body.name = entry.name;
  const auto soft = std::make_shared<SoftLattice>();
  soft->lattice = lattice_of(entry, body.mesh, messages);
  const Lattice& lattice = soft->lattice;
  if (entry.mesh.empty()) {
    std::vector<int> on_surface;
    body.mesh = surface_of(lattice, on_surface);
    for (int p : on_surface) body.embedding.add_vertex(first_particle + p);
  } else {
    body.embedding = embedding_in(lattice, body.mesh.positions, first_particle);
    soft->volume = solid_of(body.mesh).volume;
  }
  try {
    soft_body(lattice, entry.material);  // is it one? As early as can be
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + error.what());
  }
  const Placement placement{.rotation = entry.placement.rotation, .translate = entry.placement.translate};
  body.mesh = placed(std::move(body.mesh), placement, entry.name);
  body.rest = body.mesh;
  body.report = examine(body.mesh);
  TriangleMesh points;  // the particles alone
  points.positions = lattice.positions;
  soft->positions = placed(std::move(points), placement, entry.name).positions;
  body.first_particle = first_particle;
  body.end_particle = first_particle + lattice.particle_count();
  for (const auto* pairs : {&lattice.structural, &lattice.shear, &lattice.bend})
    add_edges(*pairs, lattice.positions, body);
  body.soft = soft;
  return body;
}

std::vector<double> masses_of(const SoftEntry& entry, const SoftLattice& soft) {
  return masses(soft.lattice, entry.material, soft.volume);
}

std::vector<ClothFace> faces_of(const SoftEntry& entry, const Cloth& body) {
  const Lattice& lattice = body.soft->lattice;
  const double stiffness =
      entry.material.young ? *entry.material.young * lattice.spacing[0] : entry.material.structural;
  std::vector<int> on_surface;
  std::vector<ClothFace> faces;
  for (const Triangle& t : surface_of(lattice, on_surface).triangles) {
    const auto particle = [&](std::size_t k) {
      return body.first_particle + on_surface[static_cast<std::size_t>(t[k])];
    };
    faces.push_back({{particle(0), particle(1), particle(2)}, stiffness});
  }
  return faces;
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
