// `drape compare`: solvers on the systems of one run, integrators on one scene, sizes of one sheet.
#pragma once

#include "app/compare/options.h"
#include "app/run/common_options.h"

namespace drape {

// The scene may be empty when sizes are given. Exit code: 0 all agree; 1 a solver differs, or the run or one
// of an integrator failed; 130 interrupted, and nothing is written. Throws InputError.
int compare(const std::filesystem::path& scene, const CompareWords& words, const CommonOptions& common);

}  // namespace drape
