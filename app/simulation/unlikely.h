// Messages on quantities of a scene that are possible, but most often a mistake of the unit.
#pragma once

#include "app/scene/scene.h"

namespace drape::app {

void tell_of_unlikely_values(const Scene& scene, Names& messages);

}  // namespace drape::app
