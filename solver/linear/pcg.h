// The conjugate gradient within a filter, with any preconditioner; solver/linear/pcg.cpp has the method.
#pragma once

#include "solver/linear/preconditioner.h"

namespace drape::internal {

// prefiltered: the variant of Tamstorf et al. (ppcg); otherwise that of Baraff & Witkin (mpcg).
std::unique_ptr<LinearSolver> make_pcg(std::string name, bool prefiltered,
                                       std::unique_ptr<Preconditioner> preconditioner);

}  // namespace drape::internal
