// `drape compare`: compares solvers on the systems of one run, integrators on one scene, and sizes of one
// sheet.
#pragma once

#include "app/compare/options.h"
#include "app/run/common_options.h"

namespace drape::app {

// The scene may be empty when sizes are given. Exit code: 0 when all agree; 1 when a solver differs, or when
// the run or one of an integrator has failed; 130 when interrupted, with nothing written. Throws InputError.
int compare(const std::filesystem::path& scene, const CompareWords& words, const CommonOptions& common);

}  // namespace drape::app
