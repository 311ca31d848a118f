// Makes the bodies of a scene ready to run: loads meshes and level sets, and computes the inertia of rigid
// bodies.
#pragma once

#include "app/simulation/simulation.h"

namespace drape::app {

// Adds the bodies to the constraints. `keep_level_sets`: whether a level set that had to be made is kept
// beside its mesh.
void add_obstacles(const Scene& scene, bool keep_level_sets, Simulation& simulation);

}  // namespace drape::app
