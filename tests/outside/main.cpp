// One implicit step of a sheet in free fall above a ball, by the installed library, and forces of its own:
// three particles, and four whose stencils change in every step. Exit code 0: all of it is as it should be.
#include <drape/drape.h>

#include <cmath>
#include <cstdio>

#include "forces.h"

// How far a force is from minus the slope of its energy at x, by differences.
double off_slope(drape::System& system, const drape::VecX& x) {
  const drape::VecX still = drape::VecX::Zero(x.size());
  const drape::VecX f = system.force(x, still);
  const double e = 1e-6;
  double worst = 0;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    drape::VecX up = x, down = x;
    up[k] += e;
    down[k] -= e;
    worst =
        std::fmax(worst, std::fabs(f[k] + (system.stored_energy(up) - system.stored_energy(down)) / (2 * e)));
  }
  return worst;
}

// A triangle that keeps its area, and particles above it that fall and are kept off it. The largest error.
double own_forces() {
  drape::System system({0.1, 0.1, 0.1, 0.02, 0.02});
  system.add(std::make_unique<drape::StencilForce<AreaLaw>>(
      std::vector<drape::StencilForce<AreaLaw>::Element>{{.particles = {0, 1, 2}, .rest = {0.4, 200}}}));
  system.add(std::make_unique<PointTriangleForce>(low_particles(0.3)));
  system.add(drape::gravity({0, -9.81, 0}));
  drape::Constraints constraints;
  constraints.pin({0, 1});
  drape::State state{0, drape::VecX::Zero(15), drape::VecX::Zero(15)};
  state.x << 0, 0, 0, 1, 0, 0, 0.4, 0, 0.9, 0.4, 0.2, 0.3, 0.5, 0.25, 0.25;
  drape::ImplicitEuler stepper(system, constraints, drape::make_linear_solver("mpcg"));
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    if (!stepper.advance(state, 0.01).done) return 1;
    drape::System resting({0.1, 0.1, 0.1, 0.02, 0.02});  // the same forces without gravity
    resting.add(std::make_unique<drape::StencilForce<AreaLaw>>(
        std::vector<drape::StencilForce<AreaLaw>::Element>{{.particles = {0, 1, 2}, .rest = {0.4, 200}}}));
    resting.add(std::make_unique<PointTriangleForce>(low_particles(0.3)));
    resting.begin_step({0, 0.01, state.x, state.v});
    worst = std::fmax(worst, off_slope(resting, state.x));
  }
  return worst;
}

int main() {
  if (const double off = own_forces(); off > 1e-5) {
    std::printf("own forces are off the slope of their energy by %g N\n", off);
    return 1;
  }
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
