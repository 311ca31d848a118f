// Messages on quantities of a scene that are possible, but most often a mistake, of the unit for example.
#pragma once

#include "app/scene/scene.h"

namespace drape::app {

// size [m]: of all that falls and hangs, from corner to corner.
void tell_of_unlikely_values(const Scene& scene, double size, Names& messages);

}  // namespace drape::app
