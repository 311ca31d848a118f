// The words of `drape compare` made into options. Every mistake is an InputError that names
// the option and what is known.
#pragma once

#include "app/compare/comparison.h"

namespace drape {

struct CompareWords {
  std::string solvers, steps, at, repeats, integrators, time_steps, sizes;  // empty: not given
};

CompareOptions compare_options(const CompareWords& words);

}  // namespace drape
