// A soft body of a scene: a box of particles, or the user's own mesh in cells that it passes through or that
// lie inside it.
#include "app/base/free_memory.h"
#include "app/scene/load_mesh.h"
#include "app/simulation/parts.h"
#include "mesh/base/errors.h"
#include "mesh/tetrahedra/msh.h"

namespace drape::app {
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

TetrahedralMesh tetrahedra_of(const SoftEntry& entry) {
  require_file(entry.mesh, entry.where);
  TetrahedralMesh mesh = read_msh(entry.mesh);
  for (Vec3& x : mesh.positions) x *= entry.placement.scale;
  return mesh;
}

}  // namespace

SoftPart load_soft(const SoftEntry& entry, Names& messages) {
  SoftPart part;
  part.name = entry.name;
  part.material = entry.material;
  part.place = {entry.placement.rotation, entry.placement.translate};
  part.clusters = entry.clusters;
  if (is_tetrahedra(entry.mesh)) {
    part.tetrahedra = tetrahedra_of(entry);
    return part;
  }
  MeshReport report;
  if (!entry.mesh.empty())
    part.mesh = load_mesh(entry.mesh, entry.where, {.scale = entry.placement.scale}, report, messages);
  try {
    if (!part.mesh) {
      part.lattice = box_of(entry);
      return part;
    }
    const LatticeSize size = lattice_size(*part.mesh, entry.spacing[0]);
    require_memory(size.particles, size.corners);
    part.lattice = filled_lattice(*part.mesh, entry.spacing[0], entry.mesh.string());
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + error.what());
  }
  return part;
}

}  // namespace drape::app
