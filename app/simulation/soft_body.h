// A soft body of a scene made ready: its particles and springs, and the mesh that they carry.
//   of a box      the mesh is the box's surface, whose vertices are particles
//   of a mesh     it is the user's own, in cells that it passes through or that lie inside
#pragma once

#include <memory>

#include "app/simulation/simulation.h"
#include "mesh/lattice/lattice.h"

namespace drape {

struct SoftBody {
  Cloth cloth;                   // as all that is simulated is written and looked at
  std::vector<double> masses;    // kg
  std::vector<Vec3> positions;   // m, of its particles
  std::vector<ClothFace> faces;  // of the cells
};

// Throws InputError: a mesh that cannot be read or is not closed, a lattice beyond the memory that is free.
SoftBody make_soft_body(const SoftEntry& entry, int first_particle, Names& messages);

// The particles that a pin holds: those in its box; of vertices, all that carry them.
std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x);

}  // namespace drape
