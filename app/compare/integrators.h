// Several integrators from the same start, each at several time steps: how far the ends lie apart, what
// energy they made or lost, how long they took.
#pragma once

#include "app/compare/comparison.h"
#include "app/scene/scene.h"

namespace drape {

// Fills comparison.runs, all to the time `duration` [s]. The reference is the finest run of the first-named
// integrator that got there. Every other linear solver runs at the first (the scene's) time step only: its
// row differs by linear algebra alone. False when the user interrupts.
bool compare_integrators(const Scene& scene, const CompareOptions& options, double duration, bool quiet,
                         Comparison& comparison);

}  // namespace drape
