// Warnings about what looks like a mistake in a scene that can be run all the same.
#pragma once

#include "app/simulation/simulation.h"

namespace drape::app {

// Adds "warning: ..." lines to simulation.messages.
void add_warnings(const Scene& scene, Simulation& simulation);

}  // namespace drape::app
