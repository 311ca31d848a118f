// Grids of level sets as OpenVDB files; the only place that knows OpenVDB (vdb_file.cpp). Internal.
//   "surface"  a level set: the nodes that are needed are active, the background is the largest of their
//              distances, so that other programs read it as a narrow band
//   "far"      the distances at the centres of the cells, all of them
//   "near"     which bricks are near
// Lengths are in metres; what else there is to know stands in the metadata of "surface", as drape_...
#pragma once

#include <filesystem>
#include <string>

#include "mesh/level_set/voxel_grid.h"

namespace drape::internal {

struct VdbFile {
  VoxelGrid grid;
  Vec3 origin = Vec3::Zero();  // m, where the file has node 0; the grid has it at 0
};

// Throw InputError: no such file, no OpenVDB file, no level set in it; no OpenVDB here.
VdbFile read_vdb(const std::filesystem::path& path, double scale);
std::string format_vdb(const VoxelGrid& grid);
bool reads_openvdb();  // whether this build does

}  // namespace drape::internal
