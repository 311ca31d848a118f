// The commands of the program. Each returns the exit code: 0 done, 1 the computation failed, 130 interrupted.
// Bad input is thrown as InputError.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/run/common_options.h"
#include "app/run/drop.h"

namespace drape::app {

int simulate(const std::filesystem::path& scene, const CommonOptions& options);
int drop(const DropOptions& what, const CommonOptions& options, const std::string& label);
struct LevelSetWords {
  std::string mesh, out, voxel, scale;  // as on the command line; empty when not given
};
int make_level_set(const LevelSetWords& words);

// Prints the parts of this build. which: "fabrics", "linear solvers" and so on; empty for all.
int list_parts(const std::string& which, bool markdown);

}  // namespace drape::app
