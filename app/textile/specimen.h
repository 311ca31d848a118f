// Specimens as they are cut for the tests of a textile laboratory: flat, in the plane y = 0, on an irregular
// mesh. `edge` [m] is the longest edge of the mesh.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::app {

struct Specimen {
  TriangleMesh mesh;
  std::vector<int> held;   // vertices in the clamp that stays
  std::vector<int> moved;  // vertices in the clamp that is moved, if there is one
};

// A strip along x that leaves a clamp at x = 0. The clamp holds two columns of vertices, as far before its
// edge as behind it, so that the strip begins to bend at x = 0.
Specimen overhanging_strip(double length, double width, double edge);

// A strip along x between two clamps, which hold the vertices at x = 0 and at x = length.
Specimen strip_between_clamps(double length, double width, double edge);

// A square about (side / 2, 0) in the plane of x and z, whose four sides are held: two of them by each clamp.
Specimen hinged_frame(double side, double edge);

// A disc about the origin that lies on a plate: without what lies well inside the plate, and held by two
// rings of vertices, as far inside the edge of the plate as outside.
Specimen disc_on_plate(double radius, double plate_radius, double edge);

}  // namespace drape::app
