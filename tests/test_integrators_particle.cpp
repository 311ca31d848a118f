// Constraints hold single particles in every integrator of the build: landing,
// friction, coming out of a body.
#include "solver/forces/tension_spring.h"
#include "solver/integrators/held_motion.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

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

}  // namespace

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
    if (traits_of(name).foresees) continue;
    if (contact_mode(name, method.contact) != ContactMode::constraint) continue;  // never needs it
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
