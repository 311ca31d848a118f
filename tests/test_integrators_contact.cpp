// Constraints hold in every integrator of the build: pins, contact, friction; and the same bits everywhere.
#include "app/simulation.h"
#include "solver/held_motion.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

// A soft, damped sheet over a body, that every integrator can step.
struct Drop {
  TriangleMesh mesh = grid(11, 11, 0.3, 0.3);
  System system;
  Constraints constraints;
  State state;

  explicit Drop(Shape shape, double friction = 0.3) : system(lumped_mass(mesh, 0.3)), state(at_rest(mesh)) {
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
    system.add(Gravity{});
    constraints.add(Obstacle{.shape = std::move(shape), .friction = friction});
    for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] = 0.02;
  }
};

// A mass over a plane that keeps it 1 mm away, and rubs.
struct OverPlane {
  System system{{0.1}};
  Constraints constraints;
  State state;

  OverPlane(double height, const Vec3& v, double friction) : state{0, VecX(Vec3(0, height, 0)), VecX(v)} {
    system.add(Gravity{});
    constraints.add(Obstacle{.shape = Plane{}, .friction = friction, .margin = 0.001});
  }
};

// Explicit Euler needs h below what the damping over the stiffness allows.
double step_for(std::string_view name) { return is_explicit(name) ? 4e-4 : 0.01; }

int steps_for(std::string_view name, double duration) {
  return static_cast<int>(std::lround(duration / step_for(name)));
}

}  // namespace

TEST_CASE("pinned and massless particles stay, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    const TriangleMesh mesh = grid(6, 6, 0.3, 0.3);
    std::vector<double> masses = lumped_mass(mesh, 0.3);
    masses[35] = 0;
    System system(masses);
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.pin({0, 5});
    State state = at_rest(mesh);
    state.x.array() += 0.1;  // not round
    const VecX start = state.x;
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
    for (int n = 0; n < steps_for(name, 0.3); ++n) REQUIRE(stepper->advance(state, step_for(name)).done);
    INFO(method.label);
    for (int i : {0, 5, 35}) {
      CHECK(state.x.segment<3>(3 * i) == start.segment<3>(3 * i));
      CHECK(state.v.segment<3>(3 * i).norm() == 0);
    }
    CHECK((state.x - start).cwiseAbs().maxCoeff() > 0.01);
    CHECK(state.time == Approx(0.3));
  }
}

TEST_CASE("a cloth is never inside a body and comes to rest, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const bool ball : {true, false}) {
      Drop drop = ball ? Drop(Sphere{{0, -0.1, 0}, 0.1}) : Drop(Plane{{0, 0, 0}, {0, 1, 0}});
      auto stepper =
          make_integrator(name, drop.system, drop.constraints, make_linear_solver("mpcg"), method.options());
      double deepest = 0;
      int contacts = 0;
      INFO(method.label << (ball ? " on a ball" : " on a plane"));
      for (int n = 0; n < steps_for(name, 2); ++n) {
        const StepReport report = stepper->advance(drop.state, step_for(name));
        INFO("step " << n << ": " << report.failure.what << " " << report.failure.force);
        REQUIRE(report.done);
        for (double depth : drop.constraints.penetration(drop.state.x)) deepest = std::max(deepest, depth);
        contacts = report.contacts;
      }
      CHECK(deepest < 1e-9);
      CHECK(contacts > (ball ? 5 : 100));
      CHECK(max_speed(drop.state) < (ball ? 0.03 : 0.005));
    }
  }
}

TEST_CASE("pins hold and the floor does, in one cloth, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const double height : {0.01, 0.08}) {  // begins in contact within a step or two, or in flight
      const TriangleMesh mesh = grid(9, 9, 0.3, 0.3);
      System system(lumped_mass(mesh, 0.3));
      system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.01}));
      system.add(Gravity{});
      Constraints constraints;
      constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, {0, 1, 0}}, .friction = 0.3});
      constraints.pin({0, 8});
      State state = at_rest(mesh);
      for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] = height + 0.1 * (state.x[3 * i] + 0.15);
      const State start = state;
      auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
      INFO(method.label << " from " << height << " m");
      double lowest = 1;
      int contacts = 0;
      for (int n = 0; n < steps_for(name, 1); ++n) {
        const StepReport report = stepper->advance(state, step_for(name));
        INFO("step " << n << ": " << report.failure.what);
        REQUIRE(report.done);
        CHECK(report.penetration < 1e-9);
        contacts = std::max(contacts, report.contacts);
        for (int i = 0; i < state.particles(); ++i) lowest = std::min(lowest, state.x[3 * i + 1]);
      }
      CHECK(lowest > -1e-9);
      CHECK(contacts > 30);
      for (int i : {0, 8}) {
        CHECK(state.x.segment<3>(3 * i) == start.x.segment<3>(3 * i));
        CHECK(state.v.segment<3>(3 * i).norm() == 0);
      }
      CHECK(system.kinetic_energy(state.v) + system.elastic_energy(state.x) + system.gravity_energy(state.x) <
            system.elastic_energy(start.x) + system.gravity_energy(start.x));
    }
  }
}

TEST_CASE("newton-kinsol solves its equation on crumpled cloth", "[integrators]") {
  // A T-shirt on a body, where |F| alone has false minima in most steps.
  const auto names = integrator_names();
  if (std::find(names.begin(), names.end(), "newton-kinsol") == names.end()) return;
  Simulation tee = make_simulation(read_scene(DRAPE_SOURCE_DIR "/data/scenes/tee.toml",
                                              {parse_setting("simulation.integrator=newton-kinsol")}));
  for (int n = 0; n < 10; ++n) {
    const StepReport report = tee.integrator->advance(tee.state, 0.01);
    INFO("step " << n << ": " << report.failure.what);
    REQUIRE(report.done);
    CHECK(report.converged);
    CHECK(report.substeps <= 4);  // contacts of faces come and go: kinks that may cut a step
    CHECK(report.residual <= 1e-6);
  }
}

TEST_CASE("stiff cloth that vibrates within a step keeps its energy at a contact", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    if (is_explicit(name) || name == "cvode-adams" || name == "arkode-erk") continue;
    const TriangleMesh mesh = grid(11, 11, 0.6, 0.6);
    System system(lumped_mass(mesh, 0.15));
    system.add(noh_jung(mesh, {.area_density = 0.15, .stretch = 500, .bend = 1e-5}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Sphere{{0, -0.22, 0}, 0.2}, .friction = 0.3});
    State state = at_rest(mesh);
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
    const double fall = 9.81 * 0.15 * 0.36 * 0.6;  // J: more than there is to gain
    for (int n = 0; n < 40; ++n) {
      REQUIRE(stepper->advance(state, 0.01).done);
      INFO(method.label << ", step " << n);
      CHECK(system.kinetic_energy(state.v) + system.elastic_energy(state.x) < fall);
    }
  }
}

TEST_CASE("what lands does not bounce, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const double height : {0.05, 0.051, 0.0525, 0.054}) {  // the plane is met anywhere within a step
      OverPlane m(height, {0.3, 0, 0}, 0.3);
      const State& state = m.state;
      auto stepper =
          make_integrator(name, m.system, m.constraints, make_linear_solver("mpcg"), method.options());
      const double h = is_explicit(name) ? 0.002 : 0.01;
      double top = 0;  // after the first contact
      bool landed = false;
      for (int n = 0; n < 40 || !landed; ++n) {
        REQUIRE(stepper->advance(m.state, h).done);
        landed = landed || state.x[1] < 0.0011;
        if (landed) top = std::max(top, state.x[1]);
        CHECK(state.x[1] > 0);
      }
      INFO(method.label << " from " << height << " m");
      CHECK(top < 0.0011);
      CHECK(state.v[0] < 0.3);
    }
  }
}

TEST_CASE("a particle on an incline sticks below the angle of friction and slides above it",
          "[integrators]") {
  const double mu = 0.3, g = 9.81;
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const double slope : {0.2, 0.6}) {
      const double angle = std::atan(slope);
      System system({0.1});
      system.add(Gravity{{0, -g, 0}});
      Constraints constraints;
      const Vec3 normal(-std::sin(angle), std::cos(angle), 0), down(-std::cos(angle), -std::sin(angle), 0);
      constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, normal}, .friction = mu, .margin = 0.001});
      State state{0, VecX(0.001 * normal), VecX::Zero(3)};
      auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
      const double h = is_explicit(name) ? 0.002 : 0.01;
      for (int n = 0; n < static_cast<int>(std::lround(1 / h)); ++n) REQUIRE(stepper->advance(state, h).done);
      INFO(method.label << " on a slope of " << slope);
      CHECK(state.x.dot(normal) == Approx(0.001).margin(1e-9));
      if (slope < mu) {
        CHECK(state.v.norm() < 1e-9);
        CHECK(std::abs(state.x.dot(down)) < 1e-4);
      } else {
        const double a = g * (std::sin(angle) - mu * std::cos(angle));
        CHECK(state.v.dot(down) == Approx(a).epsilon(0.02));
        CHECK(state.x.dot(down) == Approx(0.5 * a).epsilon(0.03));
      }
    }
  }
}

TEST_CASE("an impact from a hair's breadth: friction takes mu of it in that very step, and once",
          "[integrators]") {
  // The plane bears m (w + g h) in the step of the impact and m g h in others, and friction takes mu of that,
  // or all there is: step by step, and to the digit in the first.
  const double mu = 0.3, w = 1, g = 9.81, h = 0.005;  // w [m/s]: onto the plane
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const double u : {2.0, 0.2}) {
      INFO(method.label << ", thrown along the plane with " << u << " m/s");
      OverPlane m(0.001 - 1e-9, {u, -w, 0}, mu);
      auto stepper =
          make_integrator(name, m.system, m.constraints, make_linear_solver("mpcg"), method.options());
      for (int n = 1; n <= 20; ++n) {
        REQUIRE(stepper->advance(m.state, h).done);
        CHECK(m.state.v[0] ==
              Approx(std::max(u - mu * (w + g * h * n), 0.0)).margin(n == 1 ? 1e-6 : mu * g * h));
        CHECK(std::abs(m.state.v[1]) < 1e-6);  // comes up a billionth of a metre
        CHECK(m.state.x[1] == Approx(0.001).margin(1e-8));
      }
    }
  }
}

TEST_CASE(
    "a landing in the middle of a step, that is foreseen or caught: friction is neither lost nor doubled",
    "[integrators]") {
  // By the end the surface has taken all that gravity gave, and friction mu of that; how the impact is shared
  // out among the steps around it is the integrator's affair.
  const double mu = 0.3, g = 9.81;
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    const double h = is_explicit(name) ? 0.002 : 0.005;
    for (const double height : {0.05, 0.051, 0.0525, 0.054, 0.0557}) {
      INFO(method.label << " from " << height << " m");
      OverPlane m(height, {2, 0, 0}, mu);
      auto stepper =
          make_integrator(name, m.system, m.constraints, make_linear_solver("mpcg"), method.options());
      while (m.state.time < 0.3 - 1e-9) REQUIRE(stepper->advance(m.state, h).done);
      const double impact = std::sqrt(2 * g * height);  // m/s
      CHECK(m.state.v[0] == Approx(2 - mu * g * 0.3).margin(0.2 * mu * impact));
    }
  }
}

TEST_CASE("what starts inside a body is told, and comes out at the recovery speed", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    if (contact_mode(name, method.contact) != ContactMode::constraint) continue;  // test_response.cpp
    INFO(method.label);
    System system({0.1});
    system.add(Gravity{});
    Constraints constraints({.recovery_speed = 0.25});
    constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 0});
    State state{0, VecX(Vec3(0, -0.01, 0)), VecX::Zero(3)};
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
    for (int n = 0; n < 12; ++n) {
      const double depth = std::max(0.01 - 0.25 * 0.004 * n, 0.0);
      const StepReport report = stepper->advance(state, 0.004);
      CHECK(report.penetration == Approx(depth).margin(1e-12));
      CHECK(report.contacts == 1);
      CHECK(state.x[1] == Approx(-std::max(depth - 0.001, 0.0)).margin(1e-12));
      CHECK(state.v.norm() < 1e-9);
    }
  }
}

TEST_CASE("a particle with no solve left is stopped at the surface all the same, and it is told",
          "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    if (name == "implicit-euler" || name == "bdf2" || name == "newton-kinsol") continue;  // foresee it
    if (contact_mode(name, method.contact) != ContactMode::constraint) continue;          // never needs it
    INFO(method.label);
    System system({0.1});
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Box{.size = {1, 0.02, 1}}, .margin = 0.001});
    State state{0, VecX(Vec3(0, 0.05, 0)), VecX(Vec3(0, -10, 0))};
    StepOptions options;
    options.max_contact_solves = 0;
    auto stepper =
        make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options(options));
    const StepReport report = stepper->advance(state, 0.01);
    CHECK(report.guarded == 1);
    CHECK(state.x[1] >= 0.01);
  }
}

TEST_CASE("what is held during a step neither moves nor accelerates where it is held", "[integrators]") {
  System system({0.1, 0.1, 0.1});
  system.add(Gravity{});
  system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {0.5, 40}}, {1, 2, {0.5, 40}}}));
  Constraints constraints;
  constraints.pin(2);
  constraints.add(Obstacle{.shape = Plane{}, .friction = 0.0, .margin = 0.001});
  State state{0, VecX::Zero(9), VecX::Zero(9)};
  state.x << 0, 0.0009, 0, 0.8, 0.5, 0, 1.6, 0.5, 0;
  state.v << 0.4, -1, 0, 0.1, 0.2, 0.3, 5, 5, 5;
  HeldMotion motion(system, constraints);
  StepReport report;
  motion.begin(state, 0.01, report);
  const VecX& v = motion.start_velocity();
  CHECK((v.segment<3>(0) - Vec3(0.4, 0, 0)).norm() < 1e-15);  // slides along the plane
  CHECK(v.segment<3>(3) == state.v.segment<3>(3));
  CHECK(v.segment<3>(6).norm() == 0);  // pinned
  VecX a;
  motion.acceleration(state.x, v, a);
  CHECK(std::abs(a[1]) < 1e-14);
  CHECK(a[0] > 1);
  CHECK(a.segment<3>(6).norm() == 0);
  CHECK(std::abs(motion.power()) < 1e-13);  // what holds them stands still

  VecX driven = v;  // as by bodies that move: they give what the forces take
  driven.segment<3>(0) = Vec3(0, 3, 0);
  driven.segment<3>(6) = Vec3(0.5, -2, 1);
  motion.acceleration(state.x, driven, a);
  const VecX f = system.force(state.x, driven);
  CHECK(motion.power() == Approx(-3 * f[1] - Vec3(0.5, -2, 1).dot(f.segment<3>(6))));
}

TEST_CASE("contact is of first order in the time step, whatever the integrator", "[integrators]") {
  // A mass flies onto a plane, keeps what friction leaves of its speed, and slides on:
  //   x = v t' + (v - mu g t')(T - t') - mu g (T - t')^2 / 2,  t': when it lands
  const double mu = 0.2, g = 10, speed = 3, landing = 0.1, end = 0.3;
  const double exact = speed * landing + (speed - mu * g * landing) * (end - landing) -
                       0.5 * mu * g * (end - landing) * (end - landing);
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    std::vector<double> error;
    for (const int steps :
         {30, 90, 270}) {  // it lands at the same place within a step, a third before its end
      const double h = landing / (steps / 3 + 2.0 / 3);
      System system({0.1});
      system.add(Gravity{{0, -g, 0}});
      Constraints constraints;
      constraints.add(Obstacle{.shape = Plane{}, .friction = mu, .margin = 0.001});
      State state{0, VecX(Vec3(0, 0.001 + 0.5 * g * landing * landing, 0)), VecX(Vec3(speed, 0, 0))};
      StepOptions options = precise();
      options.relative_tolerance = options.absolute_tolerance_position = options.absolute_tolerance_velocity =
          1e-10;
      auto stepper =
          make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options(options));
      const int whole = static_cast<int>(end / h);
      for (int n = 0; n < whole; ++n) REQUIRE(stepper->advance(state, h).done);
      if (end - whole * h > 1e-9) REQUIRE(stepper->advance(state, end - whole * h).done);
      CHECK(state.x[1] == Approx(0.001).margin(1e-9));
      error.push_back(std::abs(state.x[0] - exact));
    }
    INFO(method.label << ": " << error[0] << ", " << error[1] << ", " << error[2]);
    CHECK(error[2] > 1e-6);
    CHECK(std::log(error[1] / error[2]) / std::log(3) == Approx(1).margin(0.35));
  }
}

TEST_CASE("every integrator gives the same bits with 1, 2 and 7 threads", "[integrators]") {
  const ThreadsRestored restored;
  const TriangleMesh mesh = grid(64, 64, 1, 1);  // above the size where threads begin
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    VecX first;
    for (int t : {1, 2, 7}) {
      set_threads(t);
      System system(lumped_mass(mesh, 0.2));
      system.add(noh_jung(mesh, {.area_density = 0.2, .stretch = 20, .bend = 1e-6, .damping = 1e-3}));
      system.add(Gravity{});
      Constraints constraints;
      constraints.pin(0);
      constraints.add(Obstacle{.shape = Sphere{{0, -0.102, 0}, 0.1}});
      State state = at_rest(mesh);
      StepOptions options;
      options.tolerance = 1e-4;
      auto stepper =
          make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options(options));
      for (int n = 0; n < 4; ++n) REQUIRE(stepper->advance(state, is_explicit(name) ? 4e-4 : 4e-3).done);
      VecX all(2 * state.x.size());
      all << state.x, state.v;
      if (first.size() == 0) first = all;
      INFO(method.label << ", " << t << " threads");
      CHECK(same_bits(all, first));
    }
  }
}
