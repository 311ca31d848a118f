// The two forms of contact without a solve, on single particles in explicit integrators.
#include "constraints/response.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

const Vec3 up(0, 1, 0), still(0, 0, 0);

// A particle of 0.1 kg over the plane y = 0 without a margin, which may turn, move, rub and spring back.
struct Particle {
  System system{{0.1}};
  Constraints constraints;
  State state{0, VecX::Zero(3), VecX::Zero(3)};
  std::unique_ptr<Integrator> stepper;

  Particle(Obstacle obstacle, const Vec3& x, const Vec3& v, ContactMode mode,
           std::string_view name = "symplectic-euler", const Vec3& g = {0, -10, 0}) {
    system.add(Gravity{g});
    constraints.add(std::move(obstacle));
    state.x = x;
    state.v = v;
    stepper =
        make_integrator(name, system, constraints, make_linear_solver("mpcg"), StepOptions{.contact = mode});
  }
  Vec3 x() const { return state.x; }
  Vec3 v() const { return state.v; }
  StepReport step(double h) {
    StepReport report = stepper->advance(state, h);
    INFO(report.failure.what);
    REQUIRE(report.done);
    return report;
  }
  double energy() const { return 0.5 * v().squaredNorm() + 10 * x()[1]; }  // J/kg
};

Obstacle floor_with(double mu, double restitution = 0) {
  return {.shape = Plane{}, .friction = mu, .margin = 0, .restitution = restitution};
}

constexpr std::array<const char*, 5> explicit_methods = {"explicit-euler", "symplectic-euler", "midpoint",
                                                         "rk4", "pbd"};

}  // namespace

TEST_CASE("a particle in symplectic Euler takes exactly the velocities of Bridson, Marino & Fedkiw 2003",
          "[response]") {
  // g = 10, h = 10 ms: v = (3, -3.9) becomes (3, -4) before the response.
  const double h = 0.01;
  for (const double mu : {0.0, 0.9}) {
    INFO("friction " << mu);
    Particle p(floor_with(mu), {0, 0.01, 0}, {3, -3.9, 0}, ContactMode::velocity);
    CHECK(p.step(h).contacts == 1);
    const double u = mu == 0 ? 3 : 0.3;
    CHECK((p.v() - Vec3(u, -1, 0)).norm() < 1e-14);
    CHECK((p.x() - Vec3(u * h, 0, 0)).norm() < 1e-15);  // on the surface
    p.step(h);  // v_N = -1.1 is taken away, and 0.99 of the slip: it stops
    CHECK((p.v() - Vec3(mu == 0 ? 3 : 0, 0, 0)).norm() < 1e-13);
  }
  Particle far(floor_with(0.9), {0, 0.05, 0}, {3, -3.9, 0}, ContactMode::velocity);
  CHECK(far.step(h).contacts == 0);
  CHECK((far.v() - Vec3(3, -4, 0)).norm() < 1e-14);
  // Random ones, of the formula on the velocity after the forces.
  for (unsigned seed = 0; seed < 200; ++seed) {
    const VecX r = random_vector(5, 1, seed);
    const double phi = 0.01 * std::abs(r[0]), mu = std::abs(r[1]);
    const Vec3 v(r[2], 2 * r[3], r[4]);
    const Vec3 x(0.1, 0.001 + phi, 0.2);
    Particle p({.shape = Plane{}, .friction = mu, .margin = 0.001}, x, v, ContactMode::velocity);
    p.step(h);
    const Vec3 expected = projected(v + h * Vec3(0, -10, 0), still, up, phi, mu, h);
    CHECK((p.v() - expected).norm() < 1e-13);
    CHECK((p.x() - x - h * expected).norm() < 1e-15);
  }
}

TEST_CASE("what rests has no velocity and what sticks does not creep, in every explicit method",
          "[response]") {
  const Vec3 n = Vec3(-0.3, 1, 0).normalized();
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution})
    for (const char* name : explicit_methods) {
      INFO(name << ", " << drape::name(mode));
      Particle p({.shape = Plane{{0, 0, 0}, n}, .friction = 0.4, .margin = 0.001, .restitution = 0.5},
                 0.001 * n, Vec3::Zero(), mode, name);
      for (int k = 0; k < 500; ++k) CHECK(p.step(0.002).contacts == 1);
      CHECK(p.v().norm() < 1e-12);
      CHECK((p.x() - 0.001 * n).norm() < 1e-12);
    }
}

TEST_CASE("on an incline friction takes mu g cos of g sin, in both modes", "[response]") {
  const double slope = 0.6, angle = std::atan(slope), mu = 0.3;
  const Vec3 n(-std::sin(angle), std::cos(angle), 0), down(-std::cos(angle), -std::sin(angle), 0);
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution})
    for (const char* name : explicit_methods) {
      INFO(name << ", " << drape::name(mode));
      Particle p({.shape = Plane{{0, 0, 0}, n}, .friction = mu, .margin = 0.001}, 0.001 * n, Vec3::Zero(),
                 mode, name);
      for (int k = 0; k < 1000; ++k) p.step(0.001);
      const double a = 10 * (std::sin(angle) - mu * std::cos(angle));
      // By pbd the velocity is a difference of places, which has more round-off.
      CHECK(p.v().dot(down) == Approx(a).epsilon(name == std::string("pbd") ? 1e-8 : 1e-9));
      CHECK(p.x().dot(down) == Approx(0.5 * a).epsilon(0.004));
      CHECK(p.x().dot(n) == Approx(0.001).margin(1e-12));
    }
}

TEST_CASE("a dropped particle rebounds to k_r^2 of its height", "[response]") {
  for (const char* name : explicit_methods)
    for (const double k_r : {1.0, 0.8, 0.5, 0.2})
      for (const double height : {0.5, 0.5123, 0.4771}) {
        Particle p({.shape = Plane{}, .margin = 0.002, .restitution = k_r}, {0, 0.002 + height, 0},
                   Vec3::Zero(), ContactMode::restitution, name);
        double expected = height;
        bool rises = false;
        int tops = 0;
        for (int k = 0; k < 20000 && tops < 2; ++k) {
          p.step(2e-4);
          if (rises && p.v()[1] <= 0) {
            ++tops;
            expected *= k_r * k_r;
            INFO(name << ", k_r = " << k_r << ", from " << height << " m, rebound " << tops);
            // What is not far above the layer of 0.1 mm bounces in it.
            if (expected > 0.005) CHECK(p.x()[1] - 0.002 == Approx(expected).epsilon(0.02));
          }
          rises = p.v()[1] > 0;
        }
        CHECK(tops == 2);
      }
}

TEST_CASE("no bounce makes energy", "[response]") {
  for (const char* name : explicit_methods) {
    if (std::string(name) == "explicit-euler") continue;  // makes it in free fall
    for (const double k_r : {1.0, 0.9, 0.3, 0.0})
      for (const double h : {0.01, 0.0031}) {
        INFO(name << ", k_r = " << k_r << ", h = " << h);
        Particle p(floor_with(0.2, k_r), {0, 0.3, 0}, {1, 0, 0}, ContactMode::restitution, name);
        double before = p.energy();
        for (int k = 0; k < 2000; ++k) {
          p.step(h);
          REQUIRE(p.energy() <= before * (1 + 1e-12) + 1e-12);
          before = p.energy();
          REQUIRE(p.x()[1] > -1e-12);
        }
        if (k_r < 0.5) CHECK(p.v().norm() < 1e-9);
      }
  }
}

TEST_CASE("a belt carries what lies on it, a lift what stands on it, by their velocities", "[response]") {
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
    INFO(drape::name(mode));
    Obstacle belt = floor_with(0.3);
    belt.motion = Motion::constant({1, 0, 0}, still, still);
    Particle carried(belt, still, still, mode);
    for (int k = 0; k < 200; ++k) carried.step(0.001);
    CHECK(carried.v()[0] == Approx(0.6).epsilon(1e-9));  // mu g t
    for (int k = 0; k < 300; ++k) carried.step(0.001);
    CHECK((carried.v() - Vec3(1, 0, 0)).norm() < 1e-12);

    Obstacle lift = floor_with(0.3);
    lift.motion = Motion::constant({0, 0.5, 0}, still, still);
    Particle lifted(lift, still, still, mode);
    for (int k = 0; k < 100; ++k) lifted.step(0.001);
    CHECK(lifted.v()[1] == Approx(0.5).margin(1e-9));
    CHECK(lifted.x()[1] == Approx(0.05).margin(1e-9));
  }
  Obstacle racket = floor_with(0, 0.5);  // v - v_b = -2 -> 1, and 1 with it
  racket.motion = Motion::constant({0, 1, 0}, still, still);
  Particle hit(racket, {0, 0.01, 0}, {0, -1, 0}, ContactMode::restitution, "rk4", still);
  for (int k = 0; k < 20; ++k) hit.step(0.001);
  CHECK(hit.v()[1] == Approx(2).epsilon(1e-12));
  CHECK(hit.x()[1] == Approx(0.005 + 0.015 * 2).epsilon(1e-9));  // met 5 mm up, at 5 ms
}

TEST_CASE("a particle in a corner is held by both planes, on its surface of neither inside", "[response]") {
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution})
    for (const char* name : explicit_methods) {
      INFO(name << ", " << drape::name(mode));
      const Vec3 left = Vec3(1, 1, 0).normalized(), right = Vec3(-1, 1, 0).normalized();
      Particle p({.shape = Plane{{0, 0, 0}, left}, .friction = 0.0, .margin = 0.001}, {0.01, 0.1, 0},
                 {0, 0, 0.2}, mode, name);
      p.constraints.add({.shape = Plane{{0, 0, 0}, right}, .friction = 0.0, .margin = 0.001});
      for (int k = 0; k < 2000; ++k) {
        p.step(0.001);
        REQUIRE(std::min(p.x().dot(left), p.x().dot(right)) > 0.001 - 1e-6);
      }
      CHECK(p.x()[1] == Approx(0.001 * std::sqrt(2)).margin(1e-4));
      CHECK(std::abs(p.v()[1]) < 1e-6);
      CHECK(p.v()[2] == Approx(0.2).epsilon(1e-9));
    }
}

TEST_CASE("what a body that reacts gets is what the particle lost", "[response]") {
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution})
    for (const double k_r : {0.0, 0.7}) {
      Obstacle ball{.shape = Sphere{{0, 0, 0}, 0.1}, .friction = 0.3, .restitution = k_r};
      ball.rigid = RigidBody{.mass = 0.3, .inertia = 1.2e-3 * Mat3::Identity(), .gravity = Vec3::Zero()};
      Particle p(ball, {0.03, 0.2, 0}, {0, -2, 0}, mode, "symplectic-euler", still);
      const ReactingBody& body = *p.constraints.bodies()[0].reacting();
      const auto momentum = [&] { return Vec3(0.1 * p.v() + body.momentum()); };
      const auto spin = [&] {
        return Vec3(p.x().cross(0.1 * p.v()) + body.centre().cross(body.momentum()) +
                    body.angular_momentum());
      };
      const Vec3 before = momentum(), spun = spin();
      for (int k = 0; k < 200; ++k) p.step(0.001);
      INFO(drape::name(mode) << ", restitution " << k_r);
      CHECK((momentum() - before).norm() < 1e-12);
      CHECK((spin() - spun).norm() < 0.02 * spun.norm());
      CHECK(body.momentum()[1] < -0.05);
      if (mode == ContactMode::restitution && k_r == 0.7) CHECK(p.v()[1] - body.velocity()[1] > 0.5);
    }
}

TEST_CASE("what starts inside comes out at the recovery speed, and keeps none of it in the soft-cube form",
          "[response]") {
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
    Particle p(floor_with(0.3), {0, -0.01, 0}, still, mode);
    for (int k = 1; k <= 9; ++k) {
      CHECK(p.step(0.004).penetration == Approx(0.01 - 0.001 * (k - 1)).margin(1e-12));
      CHECK(p.x()[1] == Approx(-0.01 + 0.001 * k).margin(1e-12));
      CHECK(p.v()[1] == Approx(mode == ContactMode::velocity ? 0.25 : 0).margin(1e-12));
    }
  }
}
