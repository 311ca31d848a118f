// What looks like a mistake in a scene that can be run all the same.
#pragma once

#include "app/simulation.h"

namespace drape {

// Adds "warning: ..." lines to simulation.messages.
void warn_if_limp(const ClothEntry& cloth, double curvature, Names& messages);  // 1/m, see limp_below
void add_warnings(const Scene& scene, Simulation& simulation);

}  // namespace drape
