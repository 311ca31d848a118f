// The frames of an animated body: which files they are, and the positions in them, placed like the rest mesh.
#pragma once

#include <memory>

#include "app/base/table.h"
#include "app/scene/scene.h"
#include "mesh/triangles/mesh_frames.h"

namespace drape::app {

// Reads the keys frames, frame_rate and frames_start of an obstacle. Without the key `frames` there are no
// files.
FramesEntry read_frames(Table& table, const std::filesystem::path& folder);

// The frame files. For a pattern they are the matching files in its folder, in the order of their numbers.
// Throws InputError when there is none, or when a number between the first and the last has no file (the
// message names that file).
std::vector<std::filesystem::path> frame_files(const FramesEntry& entry);

// Loads all frames. Throws InputError when one cannot be read or has another number of vertices than the rest
// mesh.
std::shared_ptr<const MeshFrames> load_frames(const ObstacleEntry& entry, const TriangleMesh& rest);

}  // namespace drape::app
