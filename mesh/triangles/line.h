// Lines in space, as chains of points, and the tube that such a line is drawn as.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

double length_of(const std::vector<Vec3>& line);  // m, along the line

// The ends of the line, and points on it that divide it into so many parts of the same length along it. Of a
// line without length, all points are at its start.
std::vector<Vec3> evenly_divided(const std::vector<Vec3>& line, int parts);

// A tube of a radius [m] round a line: a ring of `sides` vertices at each point, square to the mean direction
// of the segments there, and flat ends. The rings turn as little as the line does. The triangles depend on
// the number of points only, so that a line that moves keeps them. Points at one place give rings that are
// parallel.
std::vector<Vec3> tube_positions(const std::vector<Vec3>& line, double radius, int sides);
std::vector<Triangle> tube_triangles(int points, int sides);  // wound outwards

}  // namespace drape
