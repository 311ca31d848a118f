// The cloths and soft bodies of a scene, read from their files and handed to the simulation.
#pragma once

#include "app/simulation/simulation.h"

namespace drape::app {

// Cloths first, then soft bodies. Throws InputError: a mesh that cannot be read or simulated, a lattice beyond the
// memory that is free.
void load_parts(const Scene& scene, Simulation& simulation);

SoftPart load_soft(const SoftEntry& entry, Names& messages);

}  // namespace drape::app
