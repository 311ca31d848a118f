// Makes options from the words of `drape compare`. Every mistake is an InputError that names the option and
// what is allowed.
#pragma once

#include "app/compare/comparison.h"

namespace drape::app {

struct CompareWords {
  // As on the command line; empty when not given.
  std::string solvers, steps, at, repeats, integrators, time_steps, sizes;
  bool save_systems = false;
};

CompareOptions compare_options(const CompareWords& words);

}  // namespace drape::app
