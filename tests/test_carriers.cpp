// What carriers (constraints/carriers.h) are told of bodies that react, and what these get where carriers
// push.
#include <catch2/catch.hpp>

#include "constraints/contact_step.h"

using namespace drape;

namespace {

constexpr double mass = 0.1;  // kg, of the particle
const Vec3 gravity(0, -10, 0);

Obstacle ball(const Vec3& centre, double radius, double weight, const Vec3& pull) {
  const Mat3 inertia = 0.4 * weight * radius * radius * Mat3::Identity();
  return {.shape = Sphere{centre, radius},
          .friction = 0.0,
          .margin = 0,
          .rigid = RigidBody{.mass = weight, .inertia = inertia, .centre = centre, .gravity = pull}};
}

// Gives the particle a velocity, by an impulse between it and body 0, and notes how that body is seen.
struct Pusher : Carriers {
  Vec3 wanted;
  std::vector<Vec3> seen;  // m/s, velocity of body 0
  explicit Pusher(const Vec3& velocity) : wanted(velocity) {}
  void take(std::vector<SelfContact>&, const std::vector<char>&) override {}
  bool carries(int) const override { return true; }
  bool carry(std::vector<CarriedContact>& met, std::vector<SelfContact>&,
             const CarriedMotion& motion) override {
    for (CarriedContact& c : met) {
      if (c.body != 0) continue;
      seen.push_back(motion.bodies[0].velocity);
      c.taken = true;
      c.impulse = mass * (wanted - Vec3(motion.v));
      motion.v = wanted;
      motion.x = motion.start + motion.h * wanted;
    }
    return !met.empty();
  }
};

// One step of a particle from x with the velocity v.
struct Steps {
  Constraints constraints;
  Pusher pusher;
  VecX x_new, v_new;
  explicit Steps(const Vec3& wanted) : pusher(wanted) {}
  ContactStep respond(const Vec3& x, const Vec3& v, double h) {
    ContactStep step = constraints.begin_step(x, v, {mass}, 0, h, Foresight::none);
    x_new = x + h * v;
    v_new = v;
    pusher.seen.clear();
    const VecX free_x = x_new, free_v = v_new;
    step.respond(ContactMode::velocity, free_x, free_v, VecX::Zero(3), &pusher, x_new, v_new, 0);
    return step;
  }
  const ReactingBody& body(std::size_t k) const { return *constraints.bodies()[k].reacting(); }
};

}  // namespace

TEST_CASE("carriers see a body without what they gave it in the last step, whatever the lengths of the steps",
          "[clusters]") {
  constexpr double h = 1e-3;
  Steps steps({0, 0.2, 0});
  steps.constraints.add(ball({0, -0.1, 0}, 0.1, 2, gravity));
  const auto top = [&] { return Vec3(steps.body(0).centre() + Vec3(0, 0.1, 0)); };
  const Vec3 fast(0, -1, 0);
  steps.respond(top(), fast, h).finish(steps.x_new, steps.v_new);
  REQUIRE(steps.body(0).impulse_of_cloth()[1] < -0.1);
  for (const double next : {h, 0.5 * h, 2 * h}) {
    INFO(next);
    for (const double tried : {3 * h, 0.25 * h, next}) {  // the first two are given up
      const Vec3 alone = steps.body(0).velocity() + tried * gravity;
      steps.pusher.wanted[1] = 100 * tried;
      ContactStep step = steps.respond(top(), fast, tried);
      REQUIRE(!steps.pusher.seen.empty());
      for (const Vec3& velocity : steps.pusher.seen) CHECK((velocity - alone).norm() < 1e-12);
      if (tried == next) step.finish(steps.x_new, steps.v_new);
    }
  }
}

TEST_CASE(
    "where a body that reacts pushes a carried particle, no other body gets what the particle does not take",
    "[clusters]") {
  constexpr double h = 1e-3;
  Steps steps({0, -2, 0});  // into the lower ball
  steps.constraints.add(ball({0, 0.01, 0}, 0.01, 2, Vec3::Zero()));
  steps.constraints.add(ball({0, -0.011, 0}, 0.01, 2, Vec3::Zero()));
  const Vec3 v(0, 1, 0);
  steps.respond(Vec3::Zero(), v, h);
  CHECK(Vec3(steps.v_new) == steps.pusher.wanted);
  Vec3 momentum = mass * Vec3(steps.v_new);
  for (const std::size_t k : {0, 1}) momentum += steps.body(k).mass() * steps.body(k).free_velocity();
  CHECK((momentum - mass * v).norm() < 1e-14);
}
