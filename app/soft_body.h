// A soft body of a scene made ready: its particles and springs, and the mesh that they carry.
//   of a box      the mesh is the box's surface, whose vertices are particles
//   of a mesh     it is the user's own, in cells that it passes through or that lie inside
#pragma once

#include "app/simulation.h"
#include "mesh/lattice.h"

namespace drape {

struct SoftLattice {
  Lattice lattice;               // as it was made, before it was placed
  std::vector<Vec3> positions;   // m, of its particles, placed
  std::optional<double> volume;  // m^3, of a mesh
};

// Throws InputError: a mesh that cannot be read or is not closed, a lattice beyond the memory that is free.
Cloth make_soft_body(const SoftEntry& entry, int first_particle, Names& messages);

std::vector<double> masses_of(const SoftEntry& entry, const SoftLattice& soft);  // kg
std::vector<ClothFace> faces_of(const SoftEntry& entry, const Cloth& body);      // of the outer cells

// The particles that a pin holds: those in its box; of vertices, all that carry them.
std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x);

}  // namespace drape
