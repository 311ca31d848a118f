// What `drape check` says of triangles that pass through each other (mesh/distance/triangle_crossings.h), and
// the meshes that it writes to show them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/recording/recording.h"
#include "mesh/triangles/triangle_mesh.h"
#include "solver/assembly/cloth.h"

namespace drape::app {

// Throws InputError unless the folder is empty or not there, so that nothing can be replaced in it.
void require_new_folder(const std::filesystem::path& folder);

// Each of these prints how many triangles cross, and where. When `mark` is not empty, every sheet in which
// triangles cross is written into that new folder as NAME.obj, with the faces that cross in a group
// "crossing". They throw InputError when that cannot be written.

// Of a mesh.
void print_crossings(const std::string& name, const TriangleMesh& mesh, const std::filesystem::path& mark);
// Of all cloths and soft bodies, with each other and with themselves, where the particles are at x [m].
void print_crossings(const std::vector<Cloth>& cloths, const VecX& x, const std::filesystem::path& mark);
// In the frames of a run as they were written: at the start, the most, and at the end, which is what is
// marked.
void print_crossings(const Recording& recording, const std::filesystem::path& mark);

}  // namespace drape::app
