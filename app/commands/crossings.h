// What `drape check` says of triangles that pass through each other (mesh/distance/triangle_crossings.h).
#pragma once

#include <string>
#include <vector>

#include "app/recording/recording.h"
#include "mesh/triangles/triangle_mesh.h"
#include "solver/assembly/cloth.h"

namespace drape::app {

// Prints how many triangles of the mesh cross, and where.
void print_crossings(const std::string& name, const TriangleMesh& mesh);
// The same of all cloths and soft bodies, with each other and with themselves, where the particles are at x [m].
void print_crossings(const std::vector<Cloth>& cloths, const VecX& x);
// The same in the frames of a run as they were written: at the start, the most, and at the end.
void print_crossings(const Recording& recording);

}  // namespace drape::app
