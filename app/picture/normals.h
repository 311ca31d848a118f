// Smooth normals that keep edges. The normal at a corner is the mean, weighted by their angles there, of
// those faces round the vertex whose normals differ from that of the corner's own face by less than an angle.
// Vertices at the same place count as one, so that a seam of the texture does not show.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::app::drawing {

using CornerNormals = std::array<Eigen::Vector3f, 3>;  // unit vectors; zero for a triangle without area

std::vector<CornerNormals> corner_normals(const std::vector<Vec3>& positions,
                                          const std::vector<Triangle>& triangles, double crease_degrees);

}  // namespace drape::app::drawing
