// Laws of every integrator of the build: order, exact discrete values, tolerances of inner steps.
#include <Eigen/Dense>
#include <complex>

#include "solver/forces/tension_spring.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

void check_order(Course& motion, std::string_view name, int steps, double margin) {
  const State exact = fine_reference(motion);
  const double coarse = distance(run(motion, name, steps), exact);
  const double fine = distance(run(motion, name, 2 * steps), exact);
  INFO(name << ": " << coarse << " with " << steps << " steps, " << fine << " with twice as many, order "
            << std::log2(coarse / fine));
  CHECK(std::log2(coarse / fine) == Approx(order_of(name)).margin(margin));
}

// A unit mass on a spring of stiffness 1 N/m that is never slack, of frequency 1; its rest is at x[3] = 100.
struct Oscillator {
  System system{{0.0, 1.0}};
  Constraints constraints;
  State state{0, VecX::Zero(6), VecX::Zero(6)};

  Oscillator() {
    system.add(std::make_unique<PairForce<TensionSpring>>(
        std::vector<PairForce<TensionSpring>::Element>{{0, 1, {90, 1}}}));
    system.add(Gravity{{10, 0, 0}});
    state.x[3] = 100;
  }
};

// The principal root of the recurrence that the displacements obey, from four of them in a row.
std::complex<double> root_per_step(std::string_view name, double z) {
  Oscillator o;
  o.state.x[3] += 0.5;
  o.state.v[3] = 0.3;
  auto stepper = make_integrator(name, o.system, o.constraints, make_linear_solver("eigen-ldlt"), precise());
  const int settled = order_of(name) == 2 && !is_explicit(name) ? 14 : 0;  // the other roots have died out
  std::array<double, 4> y{};
  for (int n = 0; n < settled + 4; ++n) {
    if (n >= settled) y[n - settled] = o.state.x[3] - 100;
    REQUIRE(stepper->advance(o.state, z).done);
  }
  Eigen::Matrix2d Y;
  Y << y[1], y[0], y[2], y[1];
  const Eigen::Vector2d a = Y.inverse() * Eigen::Vector2d(y[2], y[3]);
  return 0.5 * a[0] + std::sqrt(std::complex<double>(0.25 * a[0] * a[0] + a[1]));
}

}  // namespace

TEST_CASE("every integrator has its order on a swinging and bouncing mass", "[integrators]") {
  Course motion = pendulum();
  for (const std::string& name : integrator_names())
    if (const int order = order_of(name); order > 0)
      check_order(motion, name, order == 1 ? 3200 : order == 2 ? 400 : 100, order == 4 ? 0.15 : 0.06);
}

TEST_CASE("every integrator has its order on a small cloth", "[integrators]") {
  Course motion = drum();
  for (const std::string& name : integrator_names())
    if (const int order = order_of(name); order > 0)
      check_order(motion, name, order == 1 ? 1600 : order == 2 ? 200 : 50, order == 4 ? 0.2 : 0.1);
}

TEST_CASE("every integrator has its order where the stiffness is not the exact one", "[integrators]") {
  Course motion = buckled();
  for (const std::string& name : integrator_names())
    if (const int order = order_of(name); order > 0)
      check_order(motion, name, order == 1 ? 1600 : order == 2 ? 200 : 50, order == 4 ? 0.2 : 0.1);
}

TEST_CASE("inner steps reach the tolerance asked for", "[integrators]") {
  for (Course (*make)() : {pendulum, drum, buckled}) {
    Course motion = make();
    const State exact = fine_reference(motion);
    for (const std::string& name : integrator_names()) {
      if (order_of(name) != 0) continue;
      const bool order_2 = name.substr(0, 5) == "cvode";  // the more steps, the more errors of single steps
      double before = 1;
      for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        StepOptions options = precise();
        options.relative_tolerance = tolerance;
        options.absolute_tolerance_position = options.absolute_tolerance_velocity = tolerance;
        const double error = distance(run(motion, name, 10, options), exact);
        INFO(name << ": tolerance " << tolerance << ", error " << error);
        CHECK(error < (order_2 ? 2 * std::pow(tolerance, 2.0 / 3) : 100 * tolerance));
        CHECK(error < 0.3 * before);
        before = error;
      }
    }
  }
}

TEST_CASE("inner steps are bounded, and the failure says what to do", "[integrators]") {
  for (const std::string& name : integrator_names()) {
    if (name != "cvode-adams" && name != "arkode-erk") continue;
    Chain chain(20, 1, 1e-3, 1e6, {1, 0, 0});
    chain.system.add(Gravity{});
    chain.constraints.pin({0, 20});
    StepOptions options;
    options.max_inner_steps = 50;
    auto stepper =
        make_integrator(name, chain.system, chain.constraints, make_linear_solver("mpcg"), options);
    const State before = chain.state;
    const StepReport report = stepper->advance(chain.state, 0.1);
    INFO(name);
    CHECK_FALSE(report.done);
    CHECK_FALSE(report.converged);
    CHECK_THAT(report.failure.what, Catch::Contains("50 inner steps") && Catch::Contains("cvode-bdf"));
    CHECK(chain.state.x == before.x);
  }
}

TEST_CASE("bdf2 keeps its order when steps change", "[integrators]") {
  Course motion = pendulum();
  const State exact = fine_reference(motion);
  std::vector<double> error;
  for (int steps : {400, 800, 1600}) {
    State s = motion.start;
    auto stepper = make_integrator("bdf2", motion.system, motion.constraints,
                                   make_linear_solver("eigen-ldlt"), precise());
    for (int n = 0; n < steps; ++n)  // one long, one short
      REQUIRE(stepper->advance(s, motion.duration / steps * (n % 2 ? 0.7 : 1.3)).done);
    error.push_back(distance(s, exact));
  }
  INFO(error[0] << " " << error[1] << " " << error[2]);
  CHECK(std::log2(error[1] / error[2]) == Approx(2).margin(0.1));
}

TEST_CASE("free fall takes the values that each scheme has exactly", "[integrators]") {
  // The distance fallen after n steps, in units of g h^2, has a closed form for each scheme.
  const double h = 0.01, g = 9.81;
  for (const std::string& name : integrator_names()) {
    if (order_of(name) == 0) continue;
    Sheet sheet(grid(4, 4, 1, 1));
    const State& state = sheet.state;
    auto stepper = make_integrator(name, sheet.system, sheet.constraints, make_linear_solver("mpcg"));
    double bdf2_error = 0, bdf2_before = 0;  // in g h^2: e_{n+1} = (4 e_n - e_{n-1}) / 3, e_0 = 0, e_1 = 1/2
    for (int n = 1; n <= 40; ++n) {
      REQUIRE(stepper->advance(sheet.state, h).done);
      const double next = n == 1 ? 0.5 : (4 * bdf2_error - bdf2_before) / 3;
      bdf2_before = std::exchange(bdf2_error, next);
      double fallen = 0.5 * n * n;
      if (name == "implicit-euler" || name == "newton-kinsol" || name == "symplectic-euler" ||
          name == "sb-implicit")
        fallen = 0.5 * n * (n + 1);
      if (name == "explicit-euler") fallen = 0.5 * n * (n - 1);
      if (name == "bdf2") fallen = 0.5 * n * n + bdf2_error;
      if (name == "pbd") fallen = 0.5 * n * (n + 1.0 / StepOptions().projection.substeps);
      INFO(name << ", step " << n);
      CHECK(-state.x[1] == Approx(fallen * g * h * h).epsilon(1e-10).margin(1e-13));
      CHECK(-state.v[1] == Approx(n * g * h).epsilon(1e-10));
    }
  }
}

TEST_CASE("an oscillator loses what its scheme takes, and runs as late", "[integrators][reference]") {
  int compared = 0;
  for (const auto& row : reference_table("integrator_oscillator.csv")) {
    const double z = row[0];
    if (z != 0.1 && z != 0.5 && z != 1) continue;
    for (const std::string& name : integrator_names()) {
      int column = -1;
      if (name == "implicit-euler" || name == "newton-kinsol") column = 1;
      if (name == "bdf2") column = 3;
      if (name == "symplectic-euler") column = 7;
      if (name == "rk4") column = 9;
      if (name == "explicit-euler") column = 11;
      double amplitude = 0, phase = 0;
      if (column > 0) {
        amplitude = row[column];
        phase = row[column + 1];
      } else if (name == "midpoint") {  // the explicit one: 1 + iz - z^2/2
        amplitude = std::sqrt(1 + z * z * z * z / 4);
        phase = std::atan2(z, 1 - z * z / 2);
      } else {
        continue;
      }
      const std::complex<double> root = root_per_step(name, z);
      INFO(name << ", z = " << z);
      CHECK(std::abs(root) == Approx(amplitude).epsilon(2e-6));
      CHECK(std::abs(std::arg(root)) == Approx(phase).epsilon(2e-6));
      ++compared;
    }
  }
  CHECK(compared >= 6);
}

TEST_CASE("a time step that is none and the state of another system are refused", "[integrators]") {
  for (const std::string& name : integrator_names()) {
    INFO(name);
    Course m = pendulum();
    auto stepper = make_integrator(name, m.system, m.constraints, make_linear_solver("mpcg"));
    State state = m.start;
    for (const double h : {0.0, -0.01, std::nan(""), std::numeric_limits<double>::infinity()})
      CHECK_THROWS_WITH(stepper->advance(state, h), Catch::Contains("time step"));
    State larger{0, VecX::Zero(9), VecX::Zero(9)}, uneven = m.start;
    uneven.v.setZero(3);
    CHECK_THROWS_AS(stepper->advance(larger, 0.01), InputError);
    CHECK_THROWS_AS(stepper->advance(uneven, 0.01), InputError);
    for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      State nowhere = m.start, away = m.start;
      nowhere.x[4] = away.v[5] = wrong;
      CHECK_THROWS_WITH(stepper->advance(nowhere, 0.01), Catch::Contains("the position of particle 1"));
      CHECK_THROWS_WITH(stepper->advance(away, 0.01), Catch::Contains("the velocity of particle 1"));
    }
    State never = m.start, nothing;
    never.time = std::nan("");
    CHECK_THROWS_WITH(stepper->advance(never, 0.01), Catch::Contains("its time"));
    Constraints none;
    System empty({});
    CHECK_THROWS_WITH(
        make_integrator(name, empty, none, make_linear_solver("eigen-ldlt"))->advance(nothing, 0.01),
        Catch::Contains("no particles"));
    CHECK(state.x == m.start.x);
    CHECK(state.time == 0);
  }
}

TEST_CASE("order 1 is Baraff & Witkin's step", "[integrators]") {
  // (M + h D + h^2 K) dv = h (f - h K v), dense, K and D by differences of the force: taut springs,
  // so that nothing is clamped.
  Course m = drum();
  m.start.v = random_vector(m.start.x.size(), 0.1, 5);
  for (int i : m.constraints.pinned()) m.start.v.segment<3>(3 * i).setZero();
  const Eigen::Index n = m.start.x.size();
  const double h = 0.01, d = 1e-5;
  Eigen::MatrixXd K(n, n), D(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    VecX e = VecX::Zero(n);
    e[k] = d;
    K.col(k) =
        -(m.system.force(m.start.x + e, m.start.v) - m.system.force(m.start.x - e, m.start.v)) / (2 * d);
    D.col(k) =
        -(m.system.force(m.start.x, m.start.v + e) - m.system.force(m.start.x, m.start.v - e)) / (2 * d);
  }
  Eigen::MatrixXd A = h * D + h * h * K;
  for (Eigen::Index k = 0; k < n; ++k) A(k, k) += m.system.masses()[k / 3];
  VecX b = h * (m.system.force(m.start.x, m.start.v) - h * K * m.start.v);
  for (int i : m.constraints.pinned())
    for (int k = 3 * i; k < 3 * i + 3; ++k) {
      A.row(k).setZero();
      A.col(k).setZero();
      A(k, k) = 1;
      b[k] = 0;
    }
  const VecX dv = A.ldlt().solve(b);
  State s = m.start;
  auto stepper =
      make_integrator("implicit-euler", m.system, m.constraints, make_linear_solver("eigen-ldlt"), precise());
  REQUIRE(stepper->advance(s, h).done);
  CHECK((s.v - m.start.v - dv).cwiseAbs().maxCoeff() < 1e-7 * dv.cwiseAbs().maxCoeff());
  CHECK((s.x - m.start.x - h * s.v).cwiseAbs().maxCoeff() < 1e-15);
}
