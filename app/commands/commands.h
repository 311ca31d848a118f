// The commands. Each gives the exit code: 0 done, 1 the computation failed, 130 interrupted; bad input is
// thrown as InputError.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/run/common_options.h"
#include "app/run/drop.h"

namespace drape {

int simulate(const std::filesystem::path& scene, const CommonOptions& options);
int drop(const DropOptions& what, const CommonOptions& options, const std::string& label);
struct LevelSetWords {
  std::string mesh, out, voxel, scale;  // as the command line gives them; empty: not given
};
int make_level_set(const LevelSetWords& words);

// which: "fabrics", "linear solvers"; empty: all.
int list_parts(const std::string& which, bool markdown);

}  // namespace drape
