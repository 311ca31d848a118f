// The bodies of a scene made ready: meshes and level sets loaded, those that react weighed.
#pragma once

#include "app/simulation/simulation.h"

namespace drape {

// Adds them to the constraints. Level sets that are made are kept beside their meshes, or not.
void add_obstacles(const Scene& scene, bool keep_level_sets, Simulation& simulation);

}  // namespace drape
