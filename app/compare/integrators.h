// Runs several integrators from the same start, each at several time steps, and reports how far the ends lie
// apart, what energy they gained or lost, and how long they took.
#pragma once

#include <functional>

#include "app/compare/comparison.h"
#include "app/simulation/simulation.h"

namespace drape::app {

using MakeSimulation = std::function<Simulation()>;

// Adds to comparison.runs those of the simulation that `make` gives, which is that of the scene or a sheet
// that is solved as the scene says; all runs go to the time `duration` [s]. The reference is the run with the
// shortest step of the first integrator in the list that reached the end. The other linear solvers run at the
// first time step only, which is the scene's, so that their rows differ by linear algebra alone. Returns
// false when the user interrupts.
bool compare_integrators(const Scene& scene, const MakeSimulation& make, const CompareOptions& options,
                         double duration, bool quiet, Comparison& comparison);

}  // namespace drape::app
