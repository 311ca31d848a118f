// The frames of a deforming body: which files they are, and their positions, placed as the rest mesh is.
#pragma once

#include <memory>

#include "app/base/table.h"
#include "app/scene/scene.h"
#include "mesh/triangles/mesh_frames.h"

namespace drape {

// The keys frames, frame_rate and frames_start of an obstacle; no files when there is no key `frames`.
FramesEntry read_frames(Table& table, const std::filesystem::path& folder);

// The files there are: of a pattern those in its folder, in the order of their numbers. Throws InputError
// when there is none or a number between the first and the last has no file,
// and names the file that is missing.
std::vector<std::filesystem::path> frame_files(const FramesEntry& entry);

// All frames. Throws InputError when one cannot be read or has not as many vertices as the rest mesh.
std::shared_ptr<const MeshFrames> load_frames(const ObstacleEntry& entry, const TriangleMesh& rest);

}  // namespace drape
