// One implicit step of a sheet in free fall above a ball, by the installed library. Exit code 0: it fell as
// it should.
#include <drape/drape.h>

#include <cmath>
#include <cstdio>

int main() {
  const drape::TriangleMesh sheet = drape::grid(11, 11, 1.0, 1.0);  // m
  drape::System system(drape::lumped_mass(sheet, 0.15));            // kg/m^2
  system.add(drape::noh_jung(sheet, {.stretch = 500, .bend = 1e-5}));
  system.add(drape::gravity({0, -9.81, 0}));
  drape::Constraints constraints;
  constraints.add(
      drape::Obstacle{.shape = drape::Sphere{.centre = {0, -1, 0}, .radius = 0.3}, .friction = 0.3});
  drape::ImplicitEuler stepper(system, constraints, drape::make_linear_solver("mpcg"));
  drape::State state = drape::at_rest(sheet);

  const double h = 0.01;  // s
  const drape::StepReport report = stepper.advance(state, h);
  if (!report.done) {
    std::printf("the step failed: %s\n", report.failure.what.c_str());
    return 1;
  }
  const double expected = -9.81 * h * h;  // m, backward Euler's first step from standing still
  double worst = 0;
  for (int i = 0; i < state.particles(); ++i)
    worst = std::fmax(worst, std::fabs(state.x[3 * i + 1] - expected));
  std::printf("%d particles fell by %g m in %g s, off by at most %g m\n", state.particles(), -expected, h,
              worst);
  return worst < 1e-12 ? 0 : 1;
}
