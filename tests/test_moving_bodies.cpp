// Bodies that move, and what they do to what touches them: belts, spinning balls, fast plates, pins that
// follow; bodies that the cloth moves.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/triangles/generate.h"
#include "solver/forces/damping.h"
#include "solver/forces/pair_force.h"
#include "solver/forces/tension_spring.h"
#include "tests/integrators.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double h = 0.01;  // s

// Loose particles of 10 g among bodies.
struct Particles {
  System system;
  Constraints constraints;
  State state;
  std::unique_ptr<Integrator> integrator;

  Particles(const std::vector<Vec3>& places, const std::string& name, const Vec3& g = {0, -9.81, 0})
      : Particles(places, Method{name, name, {}}, g) {}
  Particles(const std::vector<Vec3>& places, const Method& method, const Vec3& g = {0, -9.81, 0})
      : system(std::vector<double>(places.size(), 0.01)), state{0, stacked(places), {}} {
    state.v = VecX::Zero(state.x.size());
    system.add(Gravity{g});
    integrator =
        make_integrator(method.name, system, constraints, make_linear_solver("mpcg"), method.options());
  }
  Vec3 x(int i = 0) const { return state.x.segment<3>(3 * i); }
  Vec3 v(int i = 0) const { return state.v.segment<3>(3 * i); }
  void run(int steps, double step = h) {
    for (int n = 0; n < steps; ++n) REQUIRE(integrator->advance(state, step).done);
  }
};

Obstacle belt(double speed, double mu) {
  return {.shape = Plane{},
          .friction = mu,
          .margin = 0,
          .motion = Motion::constant({speed, 0, 0}, Vec3::Zero(), Vec3::Zero())};
}

}  // namespace

TEST_CASE("a moving belt carries what lies on it at its own speed, by mu g", "[moving-bodies]") {
  for (const Method& method : methods()) {
    INFO(method.label);
    Particles p({Vec3::Zero()}, method);
    p.constraints.add(belt(1, 0.3));
    p.run(20);  // v = mu g t until it sticks, at 0.34 s
    CHECK(p.v()[0] == Approx(0.3 * 9.81 * 0.2).epsilon(0.06));
    p.run(30);
    CHECK((p.v() - Vec3(1, 0, 0)).norm() < 1e-6);
    CHECK(std::abs(p.x()[1]) < 1e-9);
  }
}

TEST_CASE("without friction a moving belt carries nothing", "[moving-bodies]") {
  Particles p({Vec3::Zero()}, "implicit-euler");
  p.constraints.add(belt(1, 0));
  p.run(50);
  CHECK(p.v().norm() < 1e-9);
}

TEST_CASE("a lift takes its load with it, up and down", "[moving-bodies]") {
  for (const Method& method : methods()) {
    INFO(method.label);
    for (const auto& [speed, start] : {std::pair(0.5, 0.002), std::pair(-0.5, 0.002),
                                       std::pair(-0.5, 0.0019999), std::pair(-0.05, 0.0019999)}) {
      INFO(speed << " m/s, from " << start << " m");
      Particles p({Vec3(0, start, 0)}, method);
      p.constraints.add(
          Obstacle{.shape = Plane{}, .motion = Motion::constant({0, speed, 0}, Vec3::Zero(), Vec3::Zero())});
      p.run(40);
      CHECK(p.v()[1] == Approx(speed).margin(1e-6));
      CHECK(p.x()[1] == Approx(0.4 * speed + 0.002).margin(1e-4));
    }
  }
}

TEST_CASE("what sticks to a turning body goes round with it", "[moving-bodies]") {
  for (const Method& method : methods()) {
    INFO(method.label);
    // A turntable with the particle 0.2 m from its axis: mu g = 3.9 > 0.2 * 2^2 = 0.8 m/s^2.
    Particles p({Vec3(0.2, 0, 0)}, method);
    p.state.v = Vec3(0, 0, -0.4);
    p.constraints.add(Obstacle{.shape = Plane{},
                               .friction = 0.4,
                               .margin = 0,
                               .motion = Motion::constant(Vec3::Zero(), {0, 2, 0}, Vec3::Zero())});
    p.run(100);
    CHECK(p.x().norm() == Approx(0.2).epsilon(0.01));
    CHECK(std::atan2(-p.x()[2], p.x()[0]) == Approx(2.0).epsilon(0.01));  // 2 rad/s for 1 s
  }
}

TEST_CASE("a body that moves fast does not pass through what is in its way", "[moving-bodies]") {
  constexpr double step = 1.0 / 60;  // s: 83 mm at 5 m/s
  for (const Method& method : methods()) {
    INFO(method.label);
    Particles p({Vec3(0.04, 0, 0), Vec3(0.083, 0.01, 0.02), Vec3(0.7, 0, 0)}, method, Vec3::Zero());
    const Box plate{{0, 0, 0}, {0.004, 0.5, 0.5}};
    p.constraints.add(Obstacle{.shape = plate,
                               .friction = 0,
                               .margin = 1e-3,
                               .motion = Motion::constant({5, 0, 0}, Vec3::Zero(), Vec3::Zero())});
    for (int n = 0; n < 30; ++n) {
      REQUIRE(p.integrator->advance(p.state, step).done);
      const double front = 0.002 + 5 * p.state.time;
      for (int i = 0; i < 3; ++i) CHECK(p.x(i)[0] > front - 1e-9);
    }
    for (int i = 0; i < 3; ++i) CHECK(p.v(i)[0] >= 5 - 1e-6);
  }
}

TEST_CASE("a moving frame makes no difference: body and particle at the same speed are at rest",
          "[moving-bodies]") {
  const Vec3 drift(3, 0.5, -2);
  for (const std::string& name : {std::string("implicit-euler"), std::string("bdf2"), std::string("rk4")}) {
    INFO(name);
    Particles still({Vec3(0.1, 0.45, 0)}, name), moving({Vec3(0.1, 0.45, 0)}, name);
    moving.state.v = drift;
    still.constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, 0.4}, .friction = 0.2});
    moving.constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, 0.4},
                                    .friction = 0.2,
                                    .motion = Motion::constant(drift, Vec3::Zero(), Vec3::Zero())});
    still.run(60);
    moving.run(60);
    CHECK((moving.x() - still.x() - 0.6 * drift).norm() < 1e-6);
    CHECK((moving.v() - still.v() - drift).norm() < 1e-5);
  }
}

TEST_CASE("pins follow a body, and a path of their own", "[moving-bodies]") {
  const TriangleMesh mesh = grid(5, 5, 0.1, 0.1);
  for (const Method& method : methods()) {
    INFO(method.label);
    System system(masses(mesh, Fabric{.area_density = 0.2, .stretch = 50, .bend = 1e-6, .damping = 1e-3}));
    system.add(noh_jung(mesh, Fabric{.area_density = 0.2, .stretch = 50, .bend = 1e-6, .damping = 1e-3}));
    system.add(Gravity{});
    Constraints constraints;
    State state = at_rest(mesh);
    const Motion turn = Motion::constant({0.1, 0, 0}, {0, 1, 0}, {0.05, 0, 0});
    const Motion rise = Motion::constant({0, 0.2, 0}, Vec3::Zero(), Vec3::Zero());
    constraints.add(Obstacle{.shape = Sphere{{0, 9, 0}, 0.1}, .motion = turn});
    constraints.pin_to_body({0, 1}, 0, state.x);
    constraints.pin_along({1, 5}, rise, state.x);
    auto integrator =
        make_integrator(method.name, system, constraints, make_linear_solver("mpcg"), method.options());
    const bool short_steps = traits_of(method.name).grows_undamped || method.name == "sb-implicit";
    const double step = short_steps ? 2e-4 : 2e-3;
    const int steps = static_cast<int>(std::lround(0.1 / step));
    for (int n = 0; n < steps; ++n) REQUIRE(integrator->advance(state, step).done);
    const auto at = [&](int i) { return Vec3(state.x.segment<3>(3 * i)); };
    const auto rest = [&](int i) { return mesh.positions[i]; };
    for (int i : {0, 1}) CHECK((at(i) - turn.at(0.1).to_world(rest(i))).norm() < 1e-9);
    CHECK((at(5) - rest(5) - Vec3(0, 0.02, 0)).norm() < 1e-9);
  }
}

namespace {

// A round cloth that has come to lie on a ball of friction mu, 2.4 s after the ball began to turn (smoothly,
// up to `rate`): the speeds at which both turn then [rad/s].
struct Turning {
  double ball, cloth;
};
Turning turning(double mu, double rate) {
  const TriangleMesh mesh = disc(8, 0.35);
  const Fabric fabric{.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 5e-3};
  System system(masses(mesh, fabric));
  system.add(noh_jung(mesh, fabric));
  system.add(Gravity{});
  Constraints constraints;
  State state = at_rest(mesh);
  for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] += 0.31;
  const auto key = [&](double t, double angle) { return Keyframe{t, Vec3::Zero(), {0, angle, 0}}; };
  constraints.add(Obstacle{
      .shape = Sphere{{0, 0, 0}, 0.3},
      .friction = mu,
      .margin = 3e-3,
      .motion = Motion::keyframes(
          {key(0.6, 0), key(1.6, 0.5 * rate), key(3.6, 2.5 * rate), key(4.6, 3 * rate)}, Vec3::Zero())});
  auto stepper =
      make_integrator("implicit-euler", system, constraints, make_linear_solver("mpcg"), {.tolerance = 1e-5});
  for (int n = 0; n < 300; ++n) REQUIRE(stepper->advance(state, h).done);
  const Pose before = constraints.bodies()[0].pose();
  REQUIRE(stepper->advance(state, h).done);
  const Mat3 turn = constraints.bodies()[0].pose().rotation * before.rotation.transpose();
  double spin = 0, inertia = 0;  // of the cloth about the vertical
  for (int i = 0; i < state.particles(); ++i) {
    const Vec3 x = state.x.segment<3>(3 * i), v = state.v.segment<3>(3 * i);
    const double m = system.masses()[i];
    spin += m * (x[2] * v[0] - x[0] * v[2]);
    inertia += m * (x[0] * x[0] + x[2] * x[2]);
  }
  return {Eigen::AngleAxisd(turn).angle() / h, spin / inertia};
}

}  // namespace

TEST_CASE("a cloth on a turning ball turns with it when it is rough, and not at all when it is smooth",
          "[moving-bodies]") {
  const Turning rough = turning(0.9, 1.5), smooth = turning(0, 1.5), still = turning(0, 0);
  CHECK(rough.ball > 1);
  CHECK(rough.cloth == Approx(rough.ball).epsilon(0.05));
  // It slides off, and swings as it may.
  CHECK(smooth.cloth == Approx(still.cloth).margin(0.02 * smooth.ball));
}

TEST_CASE("a rope drawn over a drum slips at the capstan's ratio of tensions", "[moving-bodies]") {
  // Particles joined by springs over half a drum, held at one end by a soft spring, drawn at the other by a
  // pin that goes down slowly: the tensions rise to exp(mu pi) = 2.566 [Euler] (2.568 with 24 links), and
  // stay there while it slips.
  constexpr int on_drum = 24, hanging = 10;
  const double mu = 0.3, radius = 0.1, margin = 0.002, pull = 0.5, soft = 2, stiff = 2000;
  const double arc = M_PI * radius / on_drum;
  std::vector<Vec3> places = {{-radius, -2, 0}};
  for (int k = hanging; k > 0; --k) places.push_back({-radius, -k * arc, 0});
  for (int k = 0; k <= on_drum; ++k) {
    const double a = M_PI - M_PI * k / on_drum;
    places.push_back({radius * std::cos(a), radius * std::sin(a), 0});
  }
  for (int k = 1; k <= hanging; ++k) places.push_back({radius, -k * arc, 0});
  places.push_back({radius, -2, 0});
  const int n = static_cast<int>(places.size());
  const double rest = 2 - hanging * arc - pull / soft;  // m, of the soft springs
  System system(std::vector<double>(places.size(), 1e-3));
  std::vector<PairForce<TensionSpring>::Element> springs;
  std::vector<PairDamping::Element> dampers;
  for (int k = 0; k + 1 < n; ++k) {
    const double length = (places[k + 1] - places[k]).norm();
    const bool end = k == 0 || k + 2 == n;
    springs.push_back({k, k + 1, {end ? rest : length / (1 + pull / stiff), end ? soft : stiff}});
    if (!end) dampers.push_back({k, k + 1});
  }
  system.add(std::make_unique<PairForce<TensionSpring>>(springs));
  system.add(std::make_unique<PairDamping>(dampers, 0.5, DampingKind::relative));
  State state{0, stacked(places), VecX::Zero(3 * n)};
  Constraints constraints;
  constraints.pin(0);
  constraints.pin_along({n - 1}, Motion::constant({0, -0.1, 0}, Vec3::Zero(), Vec3::Zero()), state.x);
  constraints.add(
      Obstacle{.shape = Capsule{{0, 0, -1}, {0, 0, 1}, radius - margin}, .friction = mu, .margin = margin});
  auto stepper = make_integrator("implicit-euler", system, constraints, make_linear_solver("eigen-ldlt"));
  const auto tension = [&](int i, int j) {
    return soft * ((state.x.segment<3>(3 * i) - state.x.segment<3>(3 * j)).norm() - rest);
  };
  double largest = 0, slipping = 0;
  for (int k = 1; k <= 1200; ++k) {
    REQUIRE(stepper->advance(state, 0.005).done);
    const double ratio = tension(n - 2, n - 1) / tension(0, 1);
    largest = std::max(largest, ratio);
    if (k > 1000) slipping += ratio / 200;
  }
  CHECK(slipping == Approx(std::exp(mu * M_PI)).epsilon(0.03));
  CHECK(largest == Approx(std::exp(mu * M_PI)).epsilon(0.05));  // and holds no more than that before
}

TEST_CASE("a pin that is named twice is one pin, and one of no particle is refused", "[moving-bodies]") {
  Constraints constraints;
  constraints.add({.shape = Sphere{Vec3::Zero(), 0.1}});
  const VecX x = VecX::Zero(3 * 4);
  constraints.pin_to_body({3, 1, 3}, 0, x);
  constraints.pin_along({2, 2, 3}, Motion::constant(Vec3::UnitX(), Vec3::Zero(), Vec3::Zero()), x, 0);
  CHECK(constraints.moving_pins().size() == 3);
  CHECK(constraints.pinned() == std::vector<int>{1, 2, 3});
  for (const int none : {-1, 4}) {
    CHECK_THROWS_WITH(constraints.pin_to_body({none}, 0, x), Catch::Contains("there are 4 particles"));
    CHECK_THROWS_WITH(constraints.pin_along({none}, Motion(), x, 0),
                      Catch::Contains("there are 4 particles"));
  }
  constraints.pin(9);
  CHECK_THROWS_WITH(constraints.begin_step(x, x, std::vector<double>(4, 1.0), 0, 0.01, Foresight::ahead, {}),
                    Catch::Contains("particle 9 is pinned, but there are 4 particles"));
}
