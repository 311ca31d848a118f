// Whole motions against closed forms and reference curves: oscillator, chain, strip, catenary,
// cantilever, the hung sheet.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "solver/forces/buckling_spring.h"
#include "solver/forces/damping.h"
#include "solver/forces/tension_spring.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

StepOptions tight() { return {.tolerance = 1e-10}; }

// Largest error of a mass on a taut spring, one period, against the exact motion.
double oscillator_error(int steps) {
  // Along the spring; always in tension, so that the clamp never shows: x = L + a cos(w t),
  // around rest under a constant pull.
  const double k = 40, m = 0.5, L = 1, pull = 3;
  System system({0.0, m});
  system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {L, k}}}));
  system.add(Gravity{{pull, 0, 0}});
  Constraints constraints;
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"), tight());
  const double omega = std::sqrt(k / m), centre = L + m * pull / k, amplitude = 0.5 * m * pull / k;
  State state{0, VecX::Zero(6), VecX::Zero(6)};
  state.x[3] = centre + amplitude;
  const double h = 2 * M_PI / omega / steps;
  double error = 0;
  for (int n = 1; n <= steps; ++n) {
    stepper.advance(state, h);
    error = std::max(error, std::abs(state.x[3] - centre - amplitude * std::cos(omega * n * h)) / amplitude);
  }
  return error;
}

// Lets a system come to rest with long, strongly damping steps.
void settle(System& system, Constraints& constraints, State& state, double h, int steps,
            double speed = 1e-7) {
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"), tight());
  for (int n = 0; n < steps; ++n) {
    REQUIRE(stepper.advance(state, h).done);
    if (max_speed(state) < speed) return;
  }
}

}  // namespace

TEST_CASE("an oscillator converges with order 1", "[physics]") {
  const double coarse = oscillator_error(400), fine = oscillator_error(1600);
  CHECK(std::log2(coarse / fine) / 2 == Approx(1).margin(0.06));
  // And damps as the scheme must: 1/sqrt(1 + z^2) a step.
  CHECK(oscillator_error(100) < 0.25);
}

TEST_CASE("a hanging chain takes the shape of the catenary, to second order", "[physics][reference]") {
  double sag = 0;
  for (const auto& row : reference_table("catenary.csv"))
    if (row[0] == 0.5) sag = row[2];
  REQUIRE(sag > 0.39);
  std::vector<double> error;
  for (int links : {10, 20, 40}) {
    Chain chain(links, 1, 0.1, 1e5, {1, 0, 0});
    // Start on an arc whose ends are half a length apart.
    for (int k = 0; k <= links; ++k) {
      const double s = M_PI * k / links;
      chain.state.x.segment<3>(3 * k) = Vec3(-0.25 * std::cos(s), -0.4 * std::sin(s), 0);
    }
    chain.system.add(Gravity{});
    chain.constraints.pin({0, links});
    settle(chain.system, chain.constraints, chain.state, 0.05, 3000);
    error.push_back(std::abs(-chain.state.x[3 * (links / 2) + 1] - sag));
  }
  INFO(error[0] << " " << error[1] << " " << error[2]);
  CHECK(error[0] < 0.006);
  CHECK(std::log2(error[0] / error[1]) > 1.8);
  CHECK(std::log2(error[1] / error[2]) > 1.8);
}

TEST_CASE("a chain under its own weight is longer by m g L / (2 k L), for every number of links",
          "[physics]") {
  for (int links : {3, 10, 40}) {
    Chain chain(links, 1, 0.3, 50, {0, -1, 0});
    chain.system.add(Gravity{});
    chain.constraints.pin(0);
    settle(chain.system, chain.constraints, chain.state, 0.05, 3000, 1e-10);
    CHECK(-chain.state.x[3 * links + 1] - 1 == Approx(0.3 * 9.81 / (2 * 50)).epsilon(1e-6));
  }
}

TEST_CASE("a strip under its own weight is longer by sigma g L^2 / (2 Y), to second order in the mesh size",
          "[physics]") {
  const double Y = 200, sigma = 0.2, L = 1;
  std::vector<double> error;
  for (int cells : {10, 20, 40}) {
    TriangleMesh mesh = grid(3, cells + 1, 0.02, L);
    System system(lumped_mass(mesh, sigma));
    system.add(noh_jung(mesh, {.area_density = sigma, .stretch = Y, .bend = 0}));
    system.add(Gravity{{0, 0, 9.81}});
    Constraints constraints;
    constraints.pin({0, 1, 2});
    State state = at_rest(mesh);
    settle(system, constraints, state, 0.05, 2000, 1e-10);
    double mean = 0;
    for (int i = 3 * cells; i < 3 * cells + 3; ++i) mean += (state.x[3 * i + 2] - mesh.positions[i].z()) / 3;
    error.push_back(std::abs(mean / (sigma * 9.81 * L * L / (2 * Y)) - 1));
  }
  INFO(error[0] << " " << error[1] << " " << error[2]);
  CHECK(error[2] < 0.02);
  for (std::size_t k = 1; k < error.size(); ++k) CHECK(std::log2(error[k - 1] / error[k]) > 1.7);
}

TEST_CASE("a hanging chain swings with the period of the Bessel function", "[physics][reference]") {
  double omega = 0;  // of the lattice with half a mass at the tip, in sqrt(g/L)
  const auto table = reference_table("hanging_chain_periods.csv");
  omega = table[0][9];
  CHECK(omega == Approx(table[0][2]).epsilon(1e-3));  // the continuum's, to 0.1 %
  const int links = 50;
  Chain chain(links, 1, 0.1, 1e6, {0, -1, 0});
  chain.system.add(Gravity{});
  chain.constraints.pin(0);
  for (int k = 1; k <= links;
       ++k) {  // the first mode, J0(j01 sqrt(height)), half a degree of swing; every link as long as it was
    const auto mode = [&](int i) {
      return 0.01 * std::cyl_bessel_j(0, 2.4048255577 * std::sqrt(1.0 - static_cast<double>(i) / links));
    };
    const double dx = mode(k) - mode(k - 1), l = 1.0 / links;
    chain.state.x.segment<3>(3 * k) =
        chain.state.x.segment<3>(3 * k - 3) + Vec3(dx, -std::sqrt(l * l - dx * dx), 0);
  }
  ImplicitEuler stepper(chain.system, chain.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-8});
  std::vector<double> crossings;
  double before = chain.state.x[3 * links];
  const double h = 1e-3;
  while (crossings.size() < 5 && chain.state.time < 6) {
    REQUIRE(stepper.advance(chain.state, h).done);
    const double tip = chain.state.x[3 * links];
    if (tip * before < 0) crossings.push_back(chain.state.time - h * tip / (tip - before));
    before = tip;
  }
  REQUIRE(crossings.size() == 5);
  const double period = (crossings[4] - crossings[0]) / 2;
  CHECK(period == Approx(2 * M_PI / (omega * std::sqrt(9.81))).epsilon(2e-3));
}

TEST_CASE("a spinning pair of masses loses spin as backward Euler must, not more", "[physics]") {
  // L(t)/L0 = 1/sqrt(1 + 2 h w0^2 t) for a stiff rotor and the converged step.
  System system({1.0, 1.0});
  system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1, 1e6}}}));
  Constraints constraints;
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"),
                        {.newton_iterations = 30, .newton_tolerance = 0, .tolerance = 1e-12});
  State state{0, VecX::Zero(6), VecX::Zero(6)};
  const double omega = 5, h = 0.01;
  state.x << -0.5, 0, 0, 0.5, 0, 0;
  state.v << 0, -0.5 * omega, 0, 0, 0.5 * omega, 0;
  for (int n = 0; n < 100; ++n) stepper.advance(state, h);
  const Vec3 spin = Vec3(state.x.segment<3>(0)).cross(Vec3(state.v.segment<3>(0))) +
                    Vec3(state.x.segment<3>(3)).cross(Vec3(state.v.segment<3>(3)));
  CHECK(spin.z() / (0.5 * omega) == Approx(1 / std::sqrt(1 + 2 * h * omega * omega)).epsilon(2e-3));
  CHECK((state.v.segment<3>(0) + state.v.segment<3>(3)).norm() < 1e-9);  // momentum
}

TEST_CASE("the energy of a hung sheet never grows", "[physics]") {
  HungSheet sheet(16, 300, 0);
  ImplicitEuler stepper(sheet.system, sheet.constraints, make_linear_solver("mpcg"),
                        {.newton_iterations = 8, .newton_tolerance = 1e-9, .tolerance = 1e-9});
  double before = sheet.energy();
  for (int n = 0; n < 150; ++n) {
    stepper.advance(sheet.state, 0.01);
    const double after = sheet.energy();
    CHECK(after <= before + 1e-7);
    before = after;
  }
}

TEST_CASE("buckling springs are a beam: the cantilever comes to the elastica", "[physics][reference]") {
  // Gamma = w g L^3 / EI of a rod, H/W from the master curve. Links and next-but-one springs with k_b = 2/3
  // EI; the hinge on the clamp line, whose half cell is rigid, has twice that.
  const double gamma = 10, L = 0.1, mass_per_length = 0.2, EI = mass_per_length * 9.81 * L * L * L / gamma;
  double expected = 0;
  for (const auto& row : reference_table("cantilever_master.csv"))
    if (std::abs(row[0] / gamma - 1) < 1e-6) expected = row[1];
  REQUIRE(expected == Approx(1.0668).epsilon(1e-3));
  std::vector<double> error;
  for (int links : {4, 8, 16}) {
    const double h = L / links;
    std::vector<PairForce<TensionSpring>::Element> stretch;
    std::vector<PairForce<BucklingSpring>::Element> bend;
    std::vector<double> mass(static_cast<std::size_t>(links) + 2, mass_per_length * h);
    mass.back() /= 2;
    for (int k = 0; k <= links; ++k) stretch.push_back({k, k + 1, {h, 1e8}});
    for (int k = 0; k < links; ++k) {
      const double k_b = 2.0 / 3 * EI * (k == 0 ? 2 : 1);
      bend.push_back({k, k + 2, BucklingSpring::rest(2 * h, k_b, 1e9)});
    }
    System system(mass);
    system.add(std::make_unique<PairForce<TensionSpring>>(std::move(stretch)));
    system.add(std::make_unique<PairForce<BucklingSpring>>(std::move(bend)));
    system.add(Gravity{});
    Constraints constraints;
    constraints.pin({0, 1});
    State state{0, VecX::Zero(3 * (links + 2)), VecX::Zero(3 * (links + 2))};
    for (int k = 0; k < links + 2; ++k) state.x[3 * k] = (k - 1) * h;
    settle(system, constraints, state, 0.01, 40000, 1e-13);
    const int tip = links + 1;
    error.push_back(std::abs(-state.x[3 * tip + 1] / state.x[3 * tip] / expected - 1));
  }
  INFO(error[0] << " " << error[1] << " " << error[2]);
  CHECK(error[2] < 0.01);
  CHECK(std::log2(error[0] / error[1]) > 1.5);
}

TEST_CASE("a hung sheet passes half-way down at the same time on every mesh", "[physics]") {
  std::vector<double> times;
  for (int side : {32, 100, 200}) {
    HungSheet sheet(side, 1000, 1e-5);
    State& state = sheet.state;
    ImplicitEuler stepper(sheet.system, sheet.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-3});
    const int far = side * side - side / 2;  // middle of the free edge
    double before = 0, passed = 0;
    while (passed == 0 && state.time < 1) {
      REQUIRE(stepper.advance(state, 0.01).done);
      const double fallen = -state.x[3 * far + 1];
      if (fallen > 0.5) passed = state.time - 0.01 * (fallen - 0.5) / (fallen - before);
      before = fallen;
    }
    times.push_back(passed);
  }
  INFO(times[0] << " s, " << times[1] << " s, " << times[2] << " s");
  CHECK(times[0] > 0.3);
  CHECK(times[1] == Approx(times[0]).epsilon(0.01));
  CHECK(times[2] == Approx(times[0]).epsilon(0.01));
}
