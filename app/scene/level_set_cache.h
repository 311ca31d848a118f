// Keeps the level sets of OBJ files beside these files, as BODY.<hash>.vdb. The hash is taken of the bytes of
// the OBJ file, the scale, the voxel, the band and the version of the format; when one of these changes,
// another level set is made.
#pragma once

#include <filesystem>
#include <string>

#include "app/base/words.h"
#include "mesh/level_set/level_set.h"

namespace drape::app {

struct LevelSetRequest {
  std::filesystem::path mesh;  // the OBJ file
  double scale = 1;            // scale of the file; the mesh given to cached_level_set() is scaled already
  double voxel = 0;            // m; 0: chosen automatically
  double margin = 0;           // m, how far outside the surface the band must reach at least
  bool keep = true;            // whether a level set that had to be made is kept
};

// Reads the level set that was kept, or makes one and keeps it. `mesh` is what the file holds, scaled. A note
// is added when the level set cannot be kept, or when the kept file is damaged.
LevelSet cached_level_set(const TriangleMesh& mesh, const LevelSetRequest& request, Names& messages);

// "voxels of 5 mm (911104, 20.2 MB), off by at most 0.37 voxels (1.9 mm), rms 0.02"
std::string described(const LevelSet& level_set);

// Adds warnings about parts of the mesh that the grid does not show accurately.
void warn_of_error(const LevelSet& level_set, const std::string& name, Names& messages);

}  // namespace drape::app
