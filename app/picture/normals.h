// Smooth normals that keep edges: at a corner the mean, weighted by their angles there, of those faces round
// the vertex that lean away from the corner's own by less than an angle. Vertices at the same place are one,
// so that a seam of the texture does not show.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::drawing {

using CornerNormals = std::array<Eigen::Vector3f, 3>;  // unit; of a triangle without area zero

std::vector<CornerNormals> corner_normals(const std::vector<Vec3>& positions,
                                          const std::vector<Triangle>& triangles, double crease_degrees);

}  // namespace drape::drawing
