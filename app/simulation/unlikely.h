// Messages on quantities of a scene that are possible, but most often a mistake, of the unit for example.
#pragma once

#include <vector>

#include "app/scene/scene.h"
#include "constraints/moving_body.h"

namespace drape::app {

// size [m]: of all that falls and hangs, from corner to corner.
void tell_of_unlikely_values(const Scene& scene, double size, Names& messages);
// Of bodies that go from frame to frame: between two frames all of a body jumps,
// turns too far, or is turned inside out.
void warn_of_unlikely_frames(const Scene& scene, const std::vector<MovingBody>& bodies, Names& messages);

}  // namespace drape::app
