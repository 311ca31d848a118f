// Laws of every integrator of the build: order, exact discrete values, stability, conservation.
#include <Eigen/Dense>
#include <complex>

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
    if (n >= settled) y[static_cast<std::size_t>(n - settled)] = o.state.x[3] - 100;
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
      double before = 1;
      for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        StepOptions options = precise();
        options.relative_tolerance = tolerance;
        options.absolute_tolerance_position = options.absolute_tolerance_velocity = tolerance;
        const double error = distance(run(motion, name, 10, options), exact);
        INFO(name << ": tolerance " << tolerance << ", error " << error);
        CHECK(error < 100 * tolerance);
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
  // validation.md 4.10.
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
      if (name == "implicit-euler" || name == "newton-kinsol" || name == "symplectic-euler")
        fallen = 0.5 * n * (n + 1);
      if (name == "explicit-euler") fallen = 0.5 * n * (n - 1);
      if (name == "bdf2") fallen = 0.5 * n * n + bdf2_error;
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
        amplitude = row[static_cast<std::size_t>(column)];
        phase = row[static_cast<std::size_t>(column) + 1];
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

namespace {

// A taut system at rest in its pins, without damping or gravity, and its stiffness there.
struct Taut {
  System system;
  Constraints constraints;
  State rest;

  BlockMatrix stiffness() {
    BlockMatrix K(system.bind());
    VecX none = VecX::Zero(rest.x.size());
    for (const auto& force : system.forces())
      force->add_linearised(rest.x, rest.v, none, 1, Stiffness::tangent, K, none);
    return K;
  }

  VecX without_pins(VecX f) const {
    for (int i : constraints.pinned()) f.segment<3>(3 * i).setZero();
    return f;
  }

  VecX times(const BlockMatrix& K, const VecX& d) const {
    VecX rows(d.size()), product(d.size());
    to_rows(K.pattern(), d, rows);
    K.multiply(rows, product);
    to_particles(K.pattern(), product, rows);
    return without_pins(rows);
  }

  // The highest frequency [1/s]: the root of the largest eigenvalue of M^-1 K, by the power method.
  double omega() {
    const BlockMatrix K = stiffness();
    VecX y = without_pins(random_vector(rest.x.size(), 1, 11));
    double lambda = 0;
    for (int n = 0; n < 4000; ++n) {
      y = times(K, y);
      for (Eigen::Index i = 0; i < y.size(); ++i) y[i] /= system.masses()[static_cast<std::size_t>(i / 3)];
      lambda = y.norm();
      y /= lambda;
    }
    return std::sqrt(lambda);
  }

  // Does it still after so many steps, when it shakes a little?
  bool stays_calm(std::string_view name, double h) {
    State state = rest;
    state.x += without_pins(random_vector(state.x.size(), 1e-9, 3));
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"));
    for (int n = 0; n < 1000; ++n)
      if (!stepper->advance(state, h).done || (state.x - rest.x).norm() > 1e-3) return false;
    return (state.x - rest.x).norm() < 1e-6;
  }

  void check_limits(double highest, double margin) {
    for (const auto& [name, limit] : {std::pair{"symplectic-euler", 2.0}, {"rk4", 2.8284}}) {
      INFO(name);
      CHECK(stays_calm(name, (1 - margin) * limit / highest));
      CHECK_FALSE(stays_calm(name, (1 + margin) * limit / highest));
    }
    for (const char* name : {"explicit-euler", "midpoint"}) {
      INFO(name);
      CHECK_FALSE(stays_calm(name, 0.8 / highest));
    }
  }
};

// Pins at the rim of a grid of side x side particles.
std::vector<int> rim(int side) {
  std::vector<int> all;
  for (int i = 0; i < side * side; ++i)
    if (i % side == 0 || i % side == side - 1 || i < side || i >= side * (side - 1)) all.push_back(i);
  return all;
}

}  // namespace

TEST_CASE("the explicit schemes are stable up to their limits on a chain, to 2 %", "[integrators]") {
  // validation.md 4.12; the stiffest vibration of n links between two pins.
  const double k = 50, m = 0.02;
  const int links = 20;
  std::vector<PairForce<TensionSpring>::Element> elements;
  for (int i = 0; i < links; ++i) elements.push_back({i, i + 1, {1, k}});
  Taut chain{System(std::vector<double>(links + 1, m)), Constraints(), {0, VecX::Zero(63), VecX::Zero(63)}};
  chain.system.add(std::make_unique<PairForce<TensionSpring>>(std::move(elements)));
  chain.constraints.pin({0, links});
  for (int i = 0; i <= links; ++i) chain.rest.x[3 * i] = 1.1 * i;
  const double omega = 2 * std::sqrt(k / m) * std::sin(0.5 * M_PI * (links - 1) / links);
  CHECK(chain.omega() == Approx(omega).epsilon(1e-4));
  chain.check_limits(omega, 0.02);
}

TEST_CASE("the explicit schemes are stable up to their limits on a lattice, to 2 %", "[integrators]") {
  // validation.md 4.12: structural springs k and both diagonals d, omega^2 = 4 (k + d) / m in the endless
  // lattice.
  const double k = 50, d = 20, m = 0.02;
  const int side = 24;
  std::vector<PairForce<TensionSpring>::Element> elements;
  for (int i = 0; i < side * side; ++i) {
    const bool right = i % side + 1 < side, up = i + side < side * side;
    if (right) elements.push_back({i, i + 1, {1, k}});
    if (up) elements.push_back({i, i + side, {1, k}});
    if (right && up) elements.push_back({i, i + side + 1, {std::sqrt(2.0), d}});
    if (right && up) elements.push_back({i + 1, i + side, {std::sqrt(2.0), d}});
  }
  Taut lattice{System(std::vector<double>(side * side, m)),
               Constraints(),
               {0, VecX::Zero(3 * side * side), VecX::Zero(3 * side * side)}};
  lattice.system.add(std::make_unique<PairForce<TensionSpring>>(std::move(elements)));
  lattice.constraints.pin(rim(side));
  for (int i = 0; i < side * side; ++i)  // barely taut, so that the tension does not stiffen it
    lattice.rest.x.segment<3>(3 * i) = 1.001 * Vec3(i % side, 0, i / side);
  const double omega = std::sqrt(4 * (k + d) / m);
  CHECK(lattice.omega() == Approx(omega).epsilon(0.01));
  lattice.check_limits(omega, 0.02);
}

TEST_CASE("the explicit schemes are stable up to their limits on a cloth, to 2 %", "[integrators]") {
  // An uneven mesh pulled tight in a frame: the limit is from the matrix that the implicit steps assemble.
  const int side = 12;
  TriangleMesh mesh = grid(side, side, 0.4, 0.4);
  const VecX uneven = random_vector(3 * side * side, 0.008, 4);
  for (int i = 0; i < side * side; ++i)
    mesh.positions[static_cast<std::size_t>(i)] += Vec3(uneven[3 * i], 0, uneven[3 * i + 2]);
  Taut cloth{System(lumped_mass(mesh, 0.2)), Constraints(), at_rest(mesh)};
  cloth.system.add(noh_jung(mesh, {.area_density = 0.2, .stretch = 30, .bend = 1e-5}));
  cloth.constraints.pin(rim(side));
  cloth.rest.x *= 1.1;
  auto relax =
      make_integrator("implicit-euler", cloth.system, cloth.constraints, make_linear_solver("eigen-ldlt"));
  for (int n = 0; n < 600; ++n) REQUIRE(relax->advance(cloth.rest, 0.05).done);
  CHECK(max_speed(cloth.rest) < 1e-12);
  cloth.rest.v.setZero();
  // Nothing is slack, and so the stiffness is the true one.
  const VecX d = cloth.without_pins(random_vector(cloth.rest.x.size(), 1e-6, 9));
  const VecX df =
      cloth.system.force(cloth.rest.x - d, cloth.rest.v) - cloth.system.force(cloth.rest.x + d, cloth.rest.v);
  REQUIRE((0.5 * cloth.without_pins(df) - cloth.times(cloth.stiffness(), d)).norm() < 1e-5 * df.norm());
  cloth.check_limits(cloth.omega(), 0.02);
}

TEST_CASE("an explicit step that leaves the numbers is a failure that says what to do", "[integrators]") {
  for (const std::string& name : integrator_names()) {
    if (!is_explicit(name)) continue;
    Course m = drum();
    auto stepper = make_integrator(name, m.system, m.constraints, make_linear_solver("mpcg"));
    State state = m.start, before = state;
    StepReport report;
    for (int n = 0; n < 3000 && report.done; ++n) {
      before = state;
      report = stepper->advance(state, 1);
    }
    INFO(name);
    CHECK_FALSE(report.done);
    CHECK(max_speed(before) < 1e20);  // long before the numbers end
    CHECK_THAT(report.failure.what, Catch::Contains("shorter time step"));
    CHECK(report.failure.particle >= 0);
    CHECK_FALSE(report.failure.force.empty());
    CHECK((before.x.allFinite() && before.v.allFinite()));  // what came before it was no failure
    CHECK(state.x == before.x);
    CHECK(state.time == before.time);
  }
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
    CHECK(state.x == m.start.x);
    CHECK(state.time == 0);
  }
}

TEST_CASE("order 1 is Baraff & Witkin's step", "[integrators]") {
  // (M + h D + h^2 K) dv = h (f - h K v), dense, K and D by differences of the force: taut springs, so that
  // nothing is clamped.
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
  for (Eigen::Index k = 0; k < n; ++k) A(k, k) += m.system.masses()[static_cast<std::size_t>(k / 3)];
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

TEST_CASE("a rotor loses spin as its scheme does, and momentum stays", "[integrators]") {
  // validation.md 4.13: h = 0.01 s, 5 rad/s, 1 s, the equations solved.
  for (const std::string& name : integrator_names()) {
    System system({1.0, 1.0});
    const double k = is_explicit(name) ? 1e3 : 1e6, h = is_explicit(name) ? 1e-3 : 0.01;
    system.add(std::make_unique<PairForce<TensionSpring>>(
        std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1, k}}}));
    Constraints constraints;
    StepOptions options = precise();
    options.newton_iterations = 30;
    options.newton_tolerance = 0;
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("eigen-ldlt"), options);
    State state{0, VecX::Zero(6), VecX::Zero(6)};
    const double stretch = 0.5 * 25 / k;  // m w^2 r = k (2 r - 1), almost
    state.x << -0.5 - 0.5 * stretch, 0, 0, 0.5 + 0.5 * stretch, 0, 0;
    state.v << 0.7, -2.5, 0, 0.7, 2.5, 0;
    const auto spin = [&] {
      const Vec3 arm = state.x.segment<3>(3) - state.x.segment<3>(0);
      const Vec3 velocity = state.v.segment<3>(3) - state.v.segment<3>(0);
      return arm.cross(velocity).z();
    };
    const double before = spin();
    const int steps = static_cast<int>(std::lround(1 / h));
    for (int n = 0; n < steps; ++n) REQUIRE(stepper->advance(state, h).done);
    INFO(name);
    if (name == "implicit-euler" || name == "newton-kinsol")
      CHECK(spin() / before == Approx(0.8165).epsilon(2e-3));
    else if (name == "bdf2")
      CHECK(spin() / before == Approx(0.99661).epsilon(1e-3));
    else if (name == "symplectic-euler")
      CHECK(spin() / before == Approx(1).epsilon(1e-12));
    else if (name == "explicit-euler")
      CHECK(spin() / before > 1);
    else
      CHECK(spin() / before == Approx(1).epsilon(1e-3));
    CHECK(0.5 * (state.v[0] + state.v[3]) == Approx(0.7).epsilon(1e-9));
  }
}

TEST_CASE("the implicit schemes make no energy", "[integrators]") {
  for (const char* name : {"implicit-euler", "bdf2"}) {
    HungSheet sheet(12, 300, 0);
    auto stepper = make_integrator(name, sheet.system, sheet.constraints, make_linear_solver("mpcg"),
                                   {.newton_iterations = 20, .newton_tolerance = 1e-9, .tolerance = 1e-9});
    double most = sheet.energy();
    const double start = most, fall = 0.2 * 9.81 * 0.5;  // J: what there is to gain
    for (int n = 0; n < 150; ++n) {
      REQUIRE(stepper->advance(sheet.state, 0.01).done);
      most = std::max(most, sheet.energy());
    }
    INFO(name << ": " << (most - start) / fall << ", " << (sheet.energy() - start) / fall);
    CHECK(most - start < 1e-3 * fall);
    CHECK(sheet.energy() - start < -0.1 * fall);
  }
}

TEST_CASE("a sheet without gravity at rest, or drifting, is left alone", "[integrators]") {
  // Nothing sets the scale here: what is left of forces and energies is round-off, and is not to be fought.
  for (const std::string& name : integrator_names()) {
    for (const double speed : {0.0, 1e-3, 0.5}) {
      for (const double stretch : {10.0, 1e5}) {
        if (stretch > 10 && (is_explicit(name) || name == "cvode-adams" || name == "arkode-erk")) continue;
        for (const int newton : {1, 5}) {
          if (newton > 1 && (order_of(name) == 0 || is_explicit(name))) continue;  // they know no such option
          const TriangleMesh mesh = grid(9, 9, 0.6, 0.6);
          System system(lumped_mass(mesh, 0.15));
          system.add(noh_jung(mesh, {.area_density = 0.15, .stretch = stretch, .bend = 1e-5}));
          Constraints constraints;
          State state = at_rest(mesh);
          for (int i = 0; i < state.particles(); ++i) {
            state.x.segment<3>(3 * i) = rotation(0.4, {1, 2, 3}) * state.x.segment<3>(3 * i) + Vec3(3, -7, 5);
            state.v.segment<3>(3 * i) = speed * Vec3(0.6, 0, -0.8);
          }
          const State start = state;
          const StepOptions options{.newton_iterations = newton,
                                    .relative_tolerance = 1e-8,
                                    .absolute_tolerance_position = 1e-7,
                                    .absolute_tolerance_velocity = 1e-5};
          auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), options);
          INFO(name << ", " << speed << " m/s, " << stretch << " N/m, " << newton << " iterations");
          const double h = is_explicit(name) ? 0.002 : 0.01;
          for (int n = 0; n < 15; ++n) {
            const StepReport report = stepper->advance(state, h);
            INFO("step " << n << ": " << report.failure.what);
            REQUIRE(report.done);
            CHECK(report.failure.what.empty());
            CHECK(report.converged);
            CHECK(report.rescues == 0);
            CHECK(report.substeps == 1);
          }
          // Inner steps let vibrations grow to the tolerance of their positions.
          const double off = order_of(name) == 0 ? 1e-4 : 1e-9;
          CHECK((state.x - start.x - 15 * h * start.v).cwiseAbs().maxCoeff() < 1e-3 * speed + off);
          if (order_of(name) != 0) CHECK((state.v - start.v).cwiseAbs().maxCoeff() < 1e-3 * speed + off);
        }
      }
    }
  }
}
