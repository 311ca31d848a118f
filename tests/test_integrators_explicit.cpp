// The explicit schemes: their limits of stability, and what is told to be an explosion and what is not.
#include <functional>

#include "solver/forces/tension_spring.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

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
      for (Eigen::Index i = 0; i < y.size(); ++i) y[i] /= system.masses()[i / 3];
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
  // The stiffest vibration of n links between two pins: omega = 2 sqrt(k / m) sin(pi (n - 1) / (2 n)).
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
  // Structural springs k and both diagonals d: omega^2 = 4 (k + d) / m in the endless lattice.
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
  for (int i = 0; i < side * side; ++i) {  // barely taut, so that the tension does not stiffen it
    const int row = i / side, column = i % side;
    lattice.rest.x.segment<3>(3 * i) = 1.001 * Vec3(column, 0, row);
  }
  const double omega = std::sqrt(4 * (k + d) / m);
  CHECK(lattice.omega() == Approx(omega).epsilon(0.01));
  lattice.check_limits(omega, 0.02);
}

TEST_CASE("the explicit schemes are stable up to their limits on a cloth, to 2 %", "[integrators]") {
  // An uneven mesh pulled tight in a frame: the limit is from the matrix that the implicit steps assemble.
  const int side = 12;
  TriangleMesh mesh = grid(side, side, 0.4, 0.4);
  const VecX uneven = random_vector(3 * side * side, 0.008, 4);
  for (int i = 0; i < side * side; ++i) mesh.positions[i] += Vec3(uneven[3 * i], 0, uneven[3 * i + 2]);
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

TEST_CASE("an explosion in contact is a failure long before the numbers end", "[integrators]") {
  for (const std::string& name : integrator_names()) {
    if (!is_explicit(name)) continue;
    for (const double h : {0.02, 0.01, 0.006}) {  // grows by less than fourfold in a step, too
      const TriangleMesh mesh = grid(21, 21, 1, 1);
      System system(lumped_mass(mesh, 0.15));
      system.add(noh_jung(mesh, {.area_density = 0.15, .stretch = 500, .bend = 1e-5}));
      system.add(Gravity{});
      Constraints constraints;
      constraints.add(Obstacle{.shape = Sphere{{0, -0.305, 0}, 0.3}});
      State state = at_rest(mesh);
      auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"));
      StepReport report;
      for (int n = 0; n < 100 && report.done; ++n) report = stepper->advance(state, h);
      INFO(name << ", h = " << h << " s: " << max_speed(state) << " m/s at " << state.time << " s");
      CHECK_FALSE(report.done);
      CHECK(max_speed(state) < 1000);
      CHECK_THAT(report.failure.what, Catch::Contains("shorter time step"));
    }
  }
}

namespace {

// Steps of a sound motion, none of which may be taken for an explosion.
void check_sound(const std::string& what, System& system, Constraints& constraints, const State& start,
                 double h, const std::function<void(int, State&)>& meddle = {}, int steps = 2000) {
  for (const std::string& name : integrator_names()) {
    if (!is_explicit(name)) continue;
    Constraints own = constraints;
    State s = start;
    auto stepper = make_integrator(name, system, own, make_linear_solver("mpcg"));
    for (int n = 0; n < steps; ++n) {
      if (meddle) meddle(n, s);
      const StepReport report = stepper->advance(s, h);
      INFO(what << ", " << name << ", step " << n << ": " << report.failure.what);
      REQUIRE(report.done);
    }
  }
}

// A small soft sheet, stiff enough to vibrate, damped enough that explicit Euler does not explode.
struct SoftSheet {
  TriangleMesh mesh = grid(7, 7, 0.3, 0.3);
  System system{lumped_mass(mesh, 0.3)};
  Constraints constraints;
  State state = at_rest(mesh);

  SoftSheet() {
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
  }
};

}  // namespace

TEST_CASE("no sound motion is taken for an explosion, however it came to its speed", "[integrators]") {
  const double h = 4e-4;
  SoftSheet flung;  // fast from the start
  for (int i = 0; i < 49; ++i)
    flung.state.v.segment<3>(3 * i) =
        Vec3(200, 50, 0) + Vec3(0, 30, 0).cross(Vec3(flung.state.x.segment<3>(3 * i)));
  check_sound("flung", flung.system, flung.constraints, flung.state, h);

  SoftSheet falling;  // from standing still, where all energies are zero
  falling.system.add(Gravity{{0, -300, 0}});
  check_sound("falling", falling.system, falling.constraints, falling.state, h);
  falling.constraints.pin({0, 6});
  check_sound("swinging", falling.system, falling.constraints, falling.state, h);
  falling.constraints.add(Obstacle{.shape = Sphere{{0, -0.12, 0}, 0.1}});
  check_sound("in contact", falling.system, falling.constraints, falling.state, h);

  SoftSheet taut;  // all its energy is in its stretch
  taut.state.x *= 1.5;
  check_sound("let loose", taut.system, taut.constraints, taut.state, h);

  SoftSheet inside;  // nothing but the body moves it
  inside.constraints.add(Obstacle{.shape = Sphere{{0.05, -0.05, 0}, 0.1}});
  check_sound("brought out of a body", inside.system, inside.constraints, inside.state, h);

  SoftSheet still;  // a kick of so many times the energy that there was, and another one
  check_sound("kicked", still.system, still.constraints, still.state, h, [](int n, State& s) {
    if (n == 200) s.v[3 * 24] += 0.01;
    if (n == 800) s.v[3 * 24 + 2] += 10;
  });
  still.constraints.pin({0, 6});
  check_sound("pulled by its pins", still.system, still.constraints, still.state, h, [](int n, State& s) {
    if (n > 100) s.x[0] -= 1e-4, s.x[18] += 1e-4;
  });
}

TEST_CASE("what round-off begins is no explosion", "[integrators]") {
  // A spring stretched by the last bit of a number: the speed grows for long before the position can change,
  // to thousands of times the energy that there was.
  System system({0.0, 0.1});
  system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1, 10}}}));
  State state{0, VecX::Zero(6), VecX::Zero(6)};
  state.x[3] = std::nextafter(1.0, 2.0);
  Constraints constraints;
  check_sound("by the last bit", system, constraints, state, 5e-4, {}, 40000);
  double speed = 0;
  auto stepper = make_integrator("symplectic-euler", system, constraints, make_linear_solver("mpcg"));
  const double start = system.elastic_energy(state.x);
  for (int n = 0; n < 40000; ++n) {
    REQUIRE(stepper->advance(state, 5e-4).done);
    speed = std::max(speed, max_speed(state));
  }
  CHECK(0.05 * speed * speed > 1000 * start);
}

TEST_CASE("what swings just below the limit of symplectic Euler is no explosion", "[integrators]") {
  System system({0.0, 1.0});  // a spring that is never slack, of frequency 1
  system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1e-9, 1}}}));
  double swing = 0;  // of the kinetic energy, in terms of all that there was at the start
  for (const double phase : {0.0, 0.3, M_PI / 4, 1.2, 2.0, 3 * M_PI / 4, 2.8}) {
    State state{0, VecX::Zero(6), VecX::Zero(6)};
    state.x[3] = std::cos(phase);
    state.v[3] = std::sin(phase);
    Constraints constraints;
    auto stepper = make_integrator("symplectic-euler", system, constraints, make_linear_solver("mpcg"));
    const double start = system.kinetic_energy(state.v) + system.elastic_energy(state.x);
    for (int n = 0; n < 5000; ++n) {
      REQUIRE(stepper->advance(state, 1.96).done);
      swing = std::max(swing, system.kinetic_energy(state.v) / start);
    }
  }
  CHECK(swing == Approx(50).margin(5));
}
