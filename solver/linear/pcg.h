// The conjugate gradient under a filter, with any preconditioner: solver/linear/pcg.cpp says what it does.
#pragma once

#include "solver/linear/preconditioner.h"

namespace drape::internal {

// prefiltered: the reading of Tamstorf et al. (ppcg), else that of Baraff & Witkin (mpcg).
std::unique_ptr<LinearSolver> make_pcg(std::string name, bool prefiltered,
                                       std::unique_ptr<Preconditioner> preconditioner);

}  // namespace drape::internal
