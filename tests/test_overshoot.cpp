// A Newton step that raises the incremental potential, because edges that were slack have become taut, is put
// right by the next one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "solver/drape.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

struct Drop {
  int rescued = 0, newton = 0, steps = 0;
  double most_above = 0;  // what the potential at the end of a step is above all the energy before it [J]
};

// A sheet that falls on a ball and drapes over it in folds.
Drop dropped(int n, Kind kind, double height) {
  TriangleMesh sheet = bent(n, kind, 1, [&](double, double) { return 0.31 + height; });
  System system(lumped_mass(sheet, 0.2));
  system.add(noh_jung(sheet, {.area_density = 0.2, .stretch = 1000, .bend = 1e-5}));
  system.add(Gravity{});
  Constraints constraints;
  constraints.add(Obstacle{.shape = Sphere{Vec3::Zero(), 0.3}, .friction = 0.3});
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg+block-ic0"), {.tolerance = 1e-4});
  State state = at_rest(sheet);
  Drop drop;
  double fall = 0;  // the energy m (h g)^2 of the fall of one step
  for (double m : system.masses()) fall += m * 0.0981 * 0.0981;
  for (int k = 0; k < 80; ++k) {
    const double before = system.total_energy(state);
    const StepReport report = stepper.advance(state, 0.01);
    INFO("step " << k << ": " << report.failure.what);
    REQUIRE(report.done);
    CHECK(report.converged);
    drop.rescued += report.rescues > 0;
    drop.newton += report.newton_iterations;
    ++drop.steps;
    const double potential = system.stored_energy(state.x) + system.gravity_energy(state.x);
    drop.most_above = std::max(drop.most_above, potential - before - 0.051 * fall);
  }
  return drop;
}

}  // namespace

TEST_CASE("a step that overshoots is put right by the next, and does not make the steps after it overshoot",
          "[integrators]") {
  int overshot = 0, newton = 0, steps = 0;
  for (const Kind kind : kinds)
    for (const int n : {24, 32, 40}) {
      const Drop d = dropped(n, kind, 0.0002);
      INFO(n << " x " << n << " of kind " << static_cast<int>(kind) << ": " << d.rescued << " of " << d.steps
             << " steps overshot, " << d.newton << " iterations");
      CHECK(d.newton < 2.25 * d.steps);  // by chance up to 1.9 times
      CHECK(d.most_above <= 0);
      overshot += d.rescued;
      newton += d.newton;
      steps += d.steps;
    }
  CHECK(overshot > 20);
  CHECK(newton < 1.25 * steps);
}

TEST_CASE(
    "a step never ends with more potential than there was energy, also where the second solve overshoots",
    "[integrators]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  int rescues[4] = {};
  for (int k = 0; k < 240; ++k) {
    const int n = 5 + 3 * (k % 3);
    const double edge = 1.0 / (n - 1);
    const TriangleMesh sheet = bent(n, kinds[k / 3 % 3], 1, [](double, double) { return 0.0; });
    System system(lumped_mass(sheet, 0.2));
    system.add(noh_jung(sheet, {.area_density = 0.2, .stretch = 1000.0 * (1 + k % 4), .bend = 1e-5}));
    system.add(Gravity{});
    Constraints constraints;
    ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"), {.tolerance = 1e-8});
    State state = at_rest(sheet);
    double fall = 0;
    const double h = 0.01;
    for (double m : system.masses()) fall += m * 9.81 * 9.81 * h * h;
    state.x = state.x.unaryExpr([&](double x) { return 0.9 * x + 0.1 * edge * unit(random); });
    state.v = state.v.unaryExpr([&](double) { return 3 * unit(random); });
    const double before = system.total_energy(state);
    const StepReport report = stepper.advance(state, h);
    const double after = system.stored_energy(state.x) + system.gravity_energy(state.x);
    ++rescues[std::min(report.rescues, 3)];
    INFO(k << ": " << report.rescues << " rescues");
    REQUIRE(report.done);
    CHECK(after - before < 0.051 * fall + 1e-8 * std::abs(before));
  }
  CHECK(rescues[1] > 50);
  CHECK(rescues[2] > 20);
}
