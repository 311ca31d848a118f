// How a body looks: its surface where it is now. Built-in shapes are tessellated finely enough to look round
// (4 or 6 degrees an edge); they touch the true surface at their vertices.
#pragma once

#include "constraints/moving_body.h"

namespace drape {

// As it was drawn; without vertices for a plane, which has no end.
TriangleMesh drawn(const Shape& shape);

// The same at the end of the last completed step, at this time [s].
TriangleMesh present_mesh(const MovingBody& body, double time);

}  // namespace drape
