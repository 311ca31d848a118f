// Reads the cloths and soft bodies of a scene from their files and adds them to the simulation.
#pragma once

#include "app/simulation/simulation.h"

namespace drape::app {

// Adds the cloths first, then the soft bodies. Throws InputError when a mesh cannot be read or simulated, or
// when a lattice needs more memory than is free.
void load_parts(const Scene& scene, Simulation& simulation);

SoftPart load_soft(const SoftEntry& entry, Names& messages);

}  // namespace drape::app
