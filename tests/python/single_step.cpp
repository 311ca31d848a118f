// Twelve steps of the README's example by the library, with each of some integrators: its name and the hash
// of the state on a line, for tests/python/test_step.py to compare with. The sheet starts bent and stretched.
#include <drape/drape.h>

#include <cstdio>

#include "app/simulation/measure.h"

int main() {
  using namespace drape;
  using namespace drape::app;
  using namespace drape::internal;
  for (const char* const integrator : {"implicit-euler", "bdf2", "symplectic-euler"}) {
    TriangleMesh sheet = grid(11, 11, 1.0, 1.0);
    for (Vec3& x : sheet.positions) x[1] = 0.3021;
    const Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-5};
    System system(masses(sheet, fabric));
    system.add(noh_jung(sheet, fabric));
    system.add(gravity({0, -9.81, 0}));
    Constraints constraints;
    constraints.add(Obstacle{.shape = Sphere{.centre = {0, 0, 0}, .radius = 0.3}, .friction = 0.3});
    const auto stepper = make_integrator(integrator, system, constraints, make_linear_solver("mpcg"));
    State state = at_rest(sheet);
    for (int i = 0; i < state.particles(); ++i)
      state.x[3 * i + 1] += 0.05 * state.x[3 * i] * state.x[3 * i + 2];
    for (int k = 0; k < 12; ++k) stepper->advance(state, 5e-4);
    std::printf("%s %s\n", integrator, state_hash(state).c_str());
  }
}
