// Grids of level sets as OpenVDB files; the only place that knows OpenVDB (vdb_file.cpp).
// A file holds three grids:
//   "surface"  a level set: the nodes that are needed are active, and the background is the largest of their
//              distances, so that other programs read it as a narrow band
//   "far"      the distances at the centres of all cells
//   "near"     which bricks are near
// Lengths are in metres. All other data stand in the metadata of "surface", with names that begin in drape_.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/level_set/voxel_grid.h"

namespace drape::internal {

struct VdbFile {
  VoxelGrid grid;
  Vec3 origin = Vec3::Zero();  // m, where node 0 is in the file; in the grid node 0 is at 0
};

// Throw InputError when there is no such file, when it is not an OpenVDB file, when it holds no level set, or
// when this build has no OpenVDB.
VdbFile read_vdb(const std::filesystem::path& path, double scale);
std::string format_vdb(const VoxelGrid& grid);
bool reads_openvdb();  // whether this build does

}  // namespace drape::internal
