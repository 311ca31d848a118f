// What a step changes: time [s], positions x [m] and velocities v [m/s], with three numbers for each
// particle, in the order of the mesh.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct State {
  double time = 0;
  VecX x, v;

  int particles() const { return static_cast<int>(x.size() / 3); }
};

State at_rest(const TriangleMesh& mesh);

VecX stacked(const std::vector<Vec3>& points);     // n points -> 3n numbers
std::vector<Vec3> unstacked(const VecX& numbers);  // and back

}  // namespace drape
