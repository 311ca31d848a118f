// Level sets of OBJ files, kept beside them as BODY.<hash>.vdb: the hash is of the file's bytes, the scale,
// the voxel, the band and the version of the format, so that whatever changes makes another one.
#pragma once

#include <filesystem>
#include <string>

#include "app/base/words.h"
#include "mesh/level_set/level_set.h"

namespace drape {

struct LevelSetRequest {
  std::filesystem::path mesh;  // OBJ
  double scale = 1;            // of the file; what is read from it has it already
  double voxel = 0;            // m, 0: chosen
  double margin = 0;           // m, outside the surface that must lie within the band
  bool keep = true;            // one that had to be made
};

// `mesh` is what the file holds, scaled. Reads the kept level set, or makes one and keeps it. A note is added
// when it cannot be kept, or a kept one is damaged.
LevelSet cached_level_set(const TriangleMesh& mesh, const LevelSetRequest& request, Names& messages);

// "voxels of 5 mm (911104, 20.2 MB), off by at most 0.37 voxels (1.9 mm), rms 0.02"
std::string described(const LevelSet& level_set);

// Adds warnings about what the grid does not show.
void warn_of_error(const LevelSet& level_set, const std::string& name, Names& messages);

}  // namespace drape
