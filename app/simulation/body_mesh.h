// The surface of a body as a mesh, at the place where the body is. Built-in shapes are tessellated finely
// enough to look round (4 or 6 degrees for each edge); the vertices lie on the true surface.
#pragma once

#include "constraints/moving_body.h"

namespace drape {

// The mesh of the shape as it stands in the scene file. A plane and a level set give a mesh without vertices.
TriangleMesh drawn(const Shape& shape);

// The mesh of the body at the end of the last completed step, whose time is `time` [s].
TriangleMesh present_mesh(const MovingBody& body, double time);

}  // namespace drape
