// What `drape check` says of triangles that pass through each other (mesh/distance/triangle_crossings.h), and the meshes
// that it writes to show them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/recording/recording.h"
#include "mesh/triangles/triangle_mesh.h"
#include "solver/assembly/cloth.h"

namespace drape::app {

struct MarkWords {
  std::filesystem::path folder;  // none: nothing is written
  bool force = false;            // files that are there are replaced
};

// Each of these prints how many triangles cross, and where. Every sheet in which triangles cross is written into the
// folder of `mark` as NAME.obj, with the faces that cross in a group "crossing". They throw InputError when that cannot
// be written.

// Of a mesh.
void print_crossings(const std::string& name, const TriangleMesh& mesh, const MarkWords& mark);
// Of all cloths and soft bodies, with each other and with themselves, where the particles are at x [m].
void print_crossings(const std::vector<Cloth>& cloths, const VecX& x, const MarkWords& mark);
// In the frames of a run as they were written: at the start, the most, and at the end, which is what is marked.
void print_crossings(const Recording& recording, const MarkWords& mark);

}  // namespace drape::app
