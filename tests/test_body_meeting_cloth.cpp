// Bodies with mass that meet each other while the cloth pushes them, and starts that overlap.
#include <catch2/catch.hpp>

#include "constraints/contact_step.h"
#include "constraints/hull.h"
#include "mesh/triangles/generate.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81;

Obstacle ball(double mass, double radius, const Vec3& centre) {
  return {.shape = Sphere{centre, radius},
          .friction = 0.3,
          .margin = 3e-3,
          .rigid = RigidBody{
              .mass = mass, .inertia = 0.4 * mass * radius * radius * Mat3::Identity(), .centre = centre}};
}

// A sheet of 72 g, 60 cm x 60 cm, at y = 0.
struct Net {
  TriangleMesh mesh = grid(13, 13, 0.6, 0.6);
  System system{masses(mesh, fabric())};
  Constraints constraints;
  State state = at_rest(mesh);

  explicit Net(const Vec3& gravity = {0, -g, 0}) {
    system.add(noh_jung(mesh, fabric()));
    system.add(Gravity{gravity});
  }
  static Fabric fabric() { return {.area_density = 0.2, .stretch = 1000, .bend = 1e-5, .damping = 0.02}; }
  void pin_corners() { constraints.pin({0, 12, 156, 168}); }
  const ReactingBody& body(std::size_t k) const { return *constraints.bodies()[k].reacting(); }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) p += system.masses()[i] * state.v.segment<3>(3 * i);
    for (const MovingBody& moving : constraints.bodies())
      if (moving.reacting()) p += moving.reacting()->momentum();
    return p;
  }
};

}  // namespace

TEST_CASE("a ball hung from a sheet touches a table: the two share its weight", "[meeting]") {
  const double mass = 0.5, h = 0.01;
  double hangs_at = 0;
  for (double lift : {-1.0, 0.003, 0.02}) {  // m: how far the table lifts the ball; -1: there is no table
    INFO("lifted by " << lift << " m");
    Net net;
    net.pin_corners();
    net.constraints.add(ball(mass, 0.08, {0, -0.09, 0}));
    net.constraints.pin_to_body({84}, 0, net.state.x);  // the vertex in the middle, above the ball
    const double top = hangs_at - 0.08 + lift;
    if (lift > 0)
      net.constraints.add({.shape = Plane{.point = {0, top, 0}}, .friction = 0.3, .margin = 1e-3});
    ImplicitEuler stepper(net.system, net.constraints, make_linear_solver("mpcg"));
    for (int n = 0; n < 800; ++n) REQUIRE(stepper.advance(net.state, h).done);
    CHECK(net.body(0).velocity().norm() < 0.02);
    const double of_cloth = net.body(0).impulse_of_cloth()[1] / h,
                 of_table = net.body(0).impulse_of_bodies()[1] / h;
    CHECK(of_cloth + of_table == Approx(mass * g).epsilon(0.01));
    if (lift < 0) {
      hangs_at = net.body(0).centre()[1];
      CHECK(of_table == 0);
    } else {
      CHECK(of_table > 0.02 * mass * g);
      CHECK(of_cloth > 0.02 * mass * g);
      CHECK(net.body(0).centre()[1] == Approx(top + 0.08).margin(2e-5));
    }
  }
}

TEST_CASE("momentum of cloth and two bodies that meet is kept by every integrator", "[meeting]") {
  for (const Method& method : methods()) {
    if (traits_of(method.name).grows_undamped) continue;
    INFO(method.label);
    Net net(Vec3::Zero());
    Obstacle first = ball(0.2, 0.05, {0.03, 0.06, 0.02}), second = ball(0.4, 0.05, {0.04, 0.18, 0.02});
    first.rigid->gravity = second.rigid->gravity = Vec3::Zero();
    second.rigid->velocity = {0, -2, 0};
    second.restitution = first.restitution = 0.5;
    net.constraints.add(first);
    net.constraints.add(second);
    const auto stepper = make_integrator(method.name, net.system, net.constraints, make_linear_solver("mpcg"),
                                         method.options({.tolerance = 1e-8}));
    const Vec3 before = net.momentum();
    const double step = is_explicit(method.name) ? 1e-4 : 1e-3;
    for (int n = 0; n < static_cast<int>(std::lround(0.05 / step)); ++n)
      REQUIRE(stepper->advance(net.state, step).done);
    CHECK(net.body(1).velocity()[1] > -1.5);         // the second has met the first,
    CHECK(net.state.v.cwiseAbs().maxCoeff() > 0.1);  // and the first the cloth
    CHECK((net.momentum() - before).norm() < traits_of(method.name).momentum_kept_to * before.norm());
  }
}

TEST_CASE("bodies that meet under cloth have the same bits on any number of threads", "[meeting]") {
  check_same_bits([] {
    Net net;
    net.pin_corners();
    net.constraints.add(ball(0.5, 0.08, {0.02, 0.1, 0.01}));
    net.constraints.add(ball(0.3, 0.06, {0.05, 0.26, 0.01}));
    net.constraints.add({.shape = Plane{.point = {0, -0.2, 0}}});
    ImplicitEuler stepper(net.system, net.constraints, make_linear_solver("mpcg"));
    for (int n = 0; n < 60; ++n) {
      const StepReport report = stepper.advance(net.state, 0.01);
      INFO("step " << n << ": " << report.failure.what);
      REQUIRE(report.done);
    }
    return net.state;
  });
}

TEST_CASE("a body that meets no other moves by the same bits as one that is alone", "[meeting]") {
  State alone;
  for (bool others : {false, true}) {
    Net net;
    net.pin_corners();
    net.constraints.add(ball(0.5, 0.08, {0.02, 0.1, 0.01}));
    if (others) {
      net.constraints.add(ball(1, 0.1, {30, 0, 0}));
      net.constraints.add({.shape = Plane{.point = {0, -10, 0}}});
    }
    ImplicitEuler stepper(net.system, net.constraints, make_linear_solver("mpcg"));
    for (int n = 0; n < 60; ++n) REQUIRE(stepper.advance(net.state, 0.01).done);
    if (!others) alone = net.state;
    CHECK(same_bits(net.state.x, alone.x));
    CHECK(same_bits(net.state.v, alone.v));
  }
}

TEST_CASE("bodies that start inside each other are moved apart slowly, and gain no speed", "[meeting]") {
  Constraints constraints(ContactOptions{.recovery_speed = 0.25});
  for (double x : {0.0, 0.15}) {
    Obstacle body = ball(1, 0.1, {x, 0, 0});
    body.rigid->gravity = Vec3::Zero();
    constraints.add(body);
  }
  const auto overlapping = constraints.overlapping_bodies(1e-5);
  REQUIRE(overlapping.size() == 1);
  CHECK(overlapping[0].depth == Approx(0.05));
  const auto distance = [&] {
    return (constraints.bodies()[1].reacting()->centre() - constraints.bodies()[0].reacting()->centre())
        .norm();
  };
  State state;
  double before = distance();
  for (int n = 0; n < 40; ++n) {
    ContactStep step = constraints.begin_step(state.x, state.v, {}, 0.01 * n, 0.01);
    do step.receive(state.v, state.v, state.x);
    while (step.move_bodies(0));
    step.finish(state.x, state.v);
    CHECK(distance() - before < 0.25 * 0.01 * 1.001);
    before = distance();
  }
  CHECK(before == Approx(0.2 + BodyMeeting::rest_gap).margin(1e-8));
  for (const MovingBody& body : constraints.bodies()) CHECK(body.reacting()->velocity().norm() < 1e-12);
}

TEST_CASE("without Bullet two boxes with mass are refused, and balls are not", "[meeting]") {
  Constraints constraints;
  constraints.add(ball(1, 0.1, Vec3::Zero()));
  constraints.add({.shape = Box{.centre = {1, 0, 0}}});
  Obstacle box{.shape = Box{.centre = {5, 0, 0}}, .rigid = RigidBody{}};
  if (Hull::available())
    CHECK_NOTHROW(constraints.add(box));
  else
    CHECK_THROWS_WITH(constraints.add(box), Catch::Contains("libbullet-dev"));
}
