// A fabric file of parameters: a line for each with what it is from, then the lists of what was measured.
#pragma once

#include "app/textile/fitting.h"

namespace drape::app {

// `root` is the file that `named` was read from, `from` its name. `fitting` is null when formulas gave
// everything.
std::string fabric_file(const Node& root, const NamedFabric& named, const Fitting* fitting,
                        const std::string& from);

}  // namespace drape::app
