// Reads the cloths, soft bodies and ropes of a scene from their files and adds them to the simulation.
#pragma once

#include "app/simulation/simulation.h"

namespace drape::app {

// Adds the cloths first, then the soft bodies, then the ropes. Throws InputError when a mesh cannot be read
// or simulated, or when a lattice needs more memory than is free.
void load_parts(const Scene& scene, Simulation& simulation);

// Of an OBJ file or a pattern, placed. Throws InputError.
ClothPart load_cloth(const ClothEntry& entry, Names& messages);
SoftPart load_soft(const SoftEntry& entry, Names& messages);
// Finds the particles that its ends are joined to among the parts that are there.
RopePart load_rope(const RopeEntry& entry, Simulation& simulation);
// Fastens the ends of a rope to bodies, which have been added. Throws InputError when an end is outside of
// its body.
void anchor(const RopeEntry& entry, const Cloth& rope, const Scene& scene, Simulation& simulation);

}  // namespace drape::app
