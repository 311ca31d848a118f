// The surface of a body as a mesh, at the place where the body is.
#pragma once

#include "constraints/moving_body.h"

namespace drape::app {

// The mesh of the shape of the body (constraints/shape.h) at the end of the last completed step, whose time
// is `time` [s].
TriangleMesh present_mesh(const MovingBody& body, double time);

}  // namespace drape::app
