// The integrators that are in the build when SUNDIALS is. Internal to the library (not installed).
#pragma once

#include "solver/integrator.h"

namespace drape {

std::unique_ptr<Integrator> make_newton_kinsol(System& system, Constraints& constraints,
                                               std::unique_ptr<LinearSolver> solver,
                                               const StepOptions& options);

}  // namespace drape
