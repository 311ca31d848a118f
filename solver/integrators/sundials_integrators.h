// The integrators that this build has only with SUNDIALS.
#pragma once

#include "solver/integrators/integrator.h"

namespace drape::internal {

std::unique_ptr<Integrator> make_newton_kinsol(System& system, Constraints& constraints,
                                               std::unique_ptr<LinearSolver> solver,
                                               const StepOptions& options);

// The integrators of CVODE and ARKODE.
std::vector<IntegratorInfo> sundials_ode_methods();
std::unique_ptr<Integrator> make_sundials_ode(std::string_view name, System& system, Constraints& constraints,
                                              std::unique_ptr<LinearSolver> solver,
                                              const StepOptions& options);  // null: no such method

}  // namespace drape::internal
