// The two forms of contact without a solve: the formulas against numbers worked out by hand, and what they
// do to particles and cloth in explicit integrators.
#include "app/scene.h"
#include "app/simulation.h"
#include "constraints/response.h"
#include "mesh/obj.h"
#include "tests/allocations.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;
using Catch::Matchers::Contains;

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

constexpr std::array<const char*, 4> explicit_methods = {"explicit-euler", "symplectic-euler", "midpoint",
                                                         "rk4"};

}  // namespace

TEST_CASE("LS as it is written, against numbers by hand", "[response]") {
  // phi = 1 cm, h = 10 ms, v = (3, -4, 0): phi_new = 0.01 - 0.04 = -0.03, v_N' = -4 + 3 = -1.
  const Vec3 v(3, -4, 0);
  CHECK((projected(v, still, up, 0.01, 0.0, 0.01) - Vec3(3, -1, 0)).norm() < 1e-14);
  // mu = 0.9: |v_N' - v_N| = 3, v_T' = 3 max(0, 1 - 0.9) = 0.3
  CHECK((projected(v, still, up, 0.01, 0.9, 0.01) - Vec3(0.3, -1, 0)).norm() < 1e-14);
  // v_T = 2.5 < 0.9 x 3: it sticks
  CHECK(projected({2.5, -4, 0}, still, up, 0.01, 0.9, 0.01) == Vec3(0, -1, 0));
  // across both tangents: |v_T| = 5, v_T' = (3, 4) (1 - 2.7 / 5) = (1.38, 1.84)
  CHECK((projected({3, -4, 4}, still, up, 0.01, 0.9, 0.01) - Vec3(1.38, -1, 1.84)).norm() < 1e-14);
  // does not arrive: phi_new = 0.05 - 0.04; leaves; exactly arrives
  CHECK(projected(v, still, up, 0.05, 0.9, 0.01) == v);
  CHECK(projected({3, 4, 0}, still, up, 0, 0.9, 0.01) == Vec3(3, 4, 0));
  CHECK(projected({3, -1, 0}, still, up, 0.01, 0.9, 0.01) == Vec3(3, -1, 0));
  // leaves, but from too deep: phi_new = -0.05 + 0.04, v_N' = 4 + 1 = 5, v_T' = 3 - 0.9
  CHECK((projected({3, 4, 0}, still, up, -0.05, 0.9, 0.01) - Vec3(2.1, 5, 0)).norm() < 1e-14);
  // A body that comes up with 2 m/s and moves along with 1: v - v_b = (2, -6), phi_new = 0.01 - 0.06 = -0.05,
  // v_N' = -6 + 5 = -1; mu = 0.3: v_T' = 2 - 1.5 = 0.5
  CHECK((projected(v, {1, 2, 0}, up, 0.01, 0.3, 0.01) - Vec3(1.5, 1, 0)).norm() < 1e-14);
  CHECK((projected(v, {1, 2, 0}, up, 0.01, 0.0, 0.01) - Vec3(3, 1, 0)).norm() < 1e-14);
  // Static 0.9, kinetic 0.5: 2.7 < 3 slides on with 3 - 1.5, 2.7 > 2.5 stops.
  CHECK((projected(v, still, up, 0.01, {0.9, 0.5}, 0.01) - Vec3(1.5, -1, 0)).norm() < 1e-14);
  CHECK(projected({2.5, -4, 0}, still, up, 0.01, {0.9, 0.5}, 0.01) == Vec3(0, -1, 0));
  // On a slope 3:4, n = (-0.6, 0.8): v = -5 n = (3, -4), phi_new = 0.01 - 0.05, v_N' = -1
  CHECK((projected(v, still, {-0.6, 0.8, 0}, 0.01, 0.9, 0.01) - Vec3(0.6, -0.8, 0)).norm() < 1e-14);
}

TEST_CASE("SB's impact, against numbers by hand", "[response]") {
  CHECK((reflected({3, -4, 1}, still, up, 0.5) - Vec3(3, 2, 1)).norm() < 1e-14);
  CHECK((reflected({3, -4, 1}, still, up, 0) - Vec3(3, 0, 1)).norm() < 1e-14);
  CHECK((reflected({3, -4, 1}, still, up, 1) - Vec3(3, 4, 1)).norm() < 1e-14);
  CHECK(reflected({3, 4, 1}, still, up, 0.5) == Vec3(3, 4, 1));
  // a body that comes up with 2 m/s: v_N = -6 -> 3, and 2 with it
  CHECK((reflected({3, -4, 1}, {1, 2, 0}, up, 0.5) - Vec3(3, 5, 1)).norm() < 1e-14);
}

TEST_CASE("SB's step, against numbers by hand", "[response]") {
  const auto plane = [](double gap) { return ContactPlane{0, up, gap, still}; };
  // Meets the surface half way, from 2 cm with 4 m/s in 10 ms, without forces: v' = 2, x' = 0.5 h v'.
  StepVelocities s{{3, -4, 0}, {3, -4, 0}, {3, -4, 0}};
  REQUIRE(rebound(s, plane(0.02), 0.9, 0.5, 1e-4, 0.25, 0.01));
  CHECK((s.end - Vec3(3, 2, 0)).norm() < 1e-14);                 // an impact does not rub
  CHECK((0.01 * s.mean - Vec3(0.03, -0.01, 0)).norm() < 1e-14);  // from 0.02 to 0.01
  // In the layer, v.n < 0, and a force: -1 m/s in the step. v' = 0.5 x 4 - 1.
  s = {{3, -4, 0}, {3, -5, 0}, {3, -5, 0}};
  REQUIRE(rebound(s, plane(5e-5), 0.9, 0.5, 1e-4, 0.25, 0.01));
  CHECK((s.end - Vec3(3, 1, 0)).norm() < 1e-14);
  // At rest in the normal direction, pressed with 1 m/s a step: it stays there, and friction takes 0.9.
  s = {{3, 0, 0}, {3, -1, 0}, {3, -1, 0}};
  REQUIRE(rebound(s, plane(5e-5), 0.9, 0.5, 1e-4, 0.25, 0.01));
  CHECK((s.end - Vec3(2.1, 0, 0)).norm() < 1e-14);
  CHECK((s.mean - Vec3(2.1, 0, 0)).norm() < 1e-14);
  s = {{0.8, 0, 0}, {0.8, -1, 0}, {0.8, -1, 0}};  // stops, does not turn round
  REQUIRE(rebound(s, plane(5e-5), 0.9, 0.5, 1e-4, 0.25, 0.01));
  CHECK(s.end.norm() + s.mean.norm() < 1e-14);
  // Leaves, and is too far away.
  s = {{0, 4, 0}, {0, 3, 0}, {0, 3, 0}};
  CHECK_FALSE(rebound(s, plane(5e-5), 0.9, 0.5, 1e-4, 0.25, 0.01));
  s = {{0, -4, 0}, {0, -4, 0}, {0, -4, 0}};
  CHECK_FALSE(rebound(s, plane(0.041), 0.9, 0.5, 1e-4, 0.25, 0.01));
  CHECK(s.end == Vec3(0, -4, 0));
}

TEST_CASE("a particle in symplectic Euler takes exactly the velocities of LS", "[response]") {
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
      CHECK(p.v().dot(down) == Approx(a).epsilon(1e-9));
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

TEST_CASE("what starts inside comes out at the recovery speed, and keeps none of it in SB's form",
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

TEST_CASE("a sheet on a ball stays with friction and slides off without, never inside", "[response]") {
  std::array<double, 2> fallen{};
  for (const int rough : {0, 1}) {
    const TriangleMesh mesh = grid(13, 13, 0.3, 0.3);
    const Fabric fabric{.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03};
    System system(lumped_mass(mesh, 0.3));
    system.add(noh_jung(mesh, fabric));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Sphere{{0, -0.1, 0}, 0.1}, .friction = rough ? 0.9 : 0.0});
    State state = at_rest(mesh);
    for (int i = 0; i < state.particles(); ++i) {
      state.x[3 * i] += 0.04;  // not in the middle
      state.x[3 * i + 1] = 0.01;
    }
    auto stepper = make_integrator("symplectic-euler", system, constraints, make_linear_solver("mpcg"),
                                   StepOptions{.contact = ContactMode::velocity});
    int guarded = 0;
    for (int k = 0; k < 4000; ++k) {
      const StepReport report = stepper->advance(state, 4e-4);
      REQUIRE(report.done);
      guarded += report.guarded;
      if (k % 20 != 0) continue;
      for (double depth : constraints.penetration(state.x)) REQUIRE(depth < 1e-9);
    }
    CHECK(guarded == 0);
    double height = 0;
    for (int i = 0; i < state.particles(); ++i) height += state.x[3 * i + 1] / state.particles();
    fallen[static_cast<std::size_t>(rough)] = -height;
    if (rough) CHECK(max_speed(state) < 0.05);
  }
  INFO("mean depth " << fallen[0] << " m without friction, " << fallen[1] << " m with");
  CHECK(fallen[0] > 1);  // on its way down
  CHECK(fallen[1] < 0.15);
}

TEST_CASE("both forms give the same bits with 1, 2 and 7 threads", "[response]") {
  const ThreadsRestored restored;
  const TriangleMesh mesh = grid(64, 64, 1, 1);  // above the size where threads begin
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
    VecX first;
    for (int t : {1, 2, 7}) {
      set_threads(t);
      System system(lumped_mass(mesh, 0.2));
      system.add(noh_jung(mesh, {.area_density = 0.2, .stretch = 20, .bend = 1e-6, .damping = 1e-3}));
      system.add(Gravity{});
      Constraints constraints;
      constraints.pin(0);
      Obstacle ball{.shape = Sphere{{0, -0.1021, 0}, 0.1}, .restitution = 0.5};
      ball.rigid = RigidBody{.mass = 0.1, .inertia = 4e-4 * Mat3::Identity(), .gravity = Vec3::Zero()};
      constraints.add(ball);
      State state = at_rest(mesh);
      for (int i = 1; i < state.particles(); ++i) state.v[3 * i + 1] = -0.5;
      auto stepper = make_integrator("symplectic-euler", system, constraints, make_linear_solver("mpcg"),
                                     StepOptions{.contact = mode});
      int contacts = 0;
      for (int n = 0; n < 20; ++n) contacts += stepper->advance(state, 5e-4).contacts;
      CHECK(contacts > 0);
      VecX all(2 * state.x.size());
      all << state.x, state.v;
      if (first.size() == 0) first = all;
      INFO(name(mode) << ", " << t << " threads");
      CHECK(same_bits(all, first));
    }
  }
}

TEST_CASE("each integrator has its contact mode, and says which it cannot take", "[response]") {
  for (const std::string& name : integrator_names()) {
    INFO(name);
    CHECK(contact_mode(name, ContactMode::constraint) == ContactMode::constraint);
    CHECK(contact_mode(name, {}) == (is_explicit(name) ? ContactMode::velocity : ContactMode::constraint));
    for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
      if (is_explicit(name)) {
        CHECK(contact_mode(name, mode) == mode);
        continue;
      }
      System system({0.1});
      Constraints constraints;
      CHECK_THROWS_WITH(
          make_integrator(name, system, constraints, make_linear_solver("mpcg"), {.contact = mode}),
          Contains(name) && Contains("symplectic-euler") && Contains(std::string(drape::name(mode))));
    }
  }
  Constraints constraints;
  CHECK_THROWS_WITH(constraints.add({.shape = Plane{}, .restitution = 1.2}), Contains("restitution"));
}

TEST_CASE("a scene chooses the contact mode and a body its restitution", "[response]") {
  const std::string path = DRAPE_SOURCE_DIR "/data/scenes/ls-ball-09.toml";
  const auto read = [&](const std::vector<std::string>& words) {
    std::vector<Setting> settings;
    for (const std::string& word : words) settings.push_back(parse_setting(word));
    return read_scene(path, settings);
  };
  CHECK_FALSE(read_scene(DRAPE_SOURCE_DIR "/data/scenes/tee.toml", {}).simulation.step.contact);
  CHECK(read({"simulation.contact=restitution"}).simulation.step.contact == ContactMode::restitution);
  CHECK(read({"obstacle.ball.restitution=0.4"}).obstacles[0].obstacle.restitution == 0.4);
  CHECK_THROWS_WITH(read({"obstacle.ball.restitution=1.4"}), Contains("from 0 to 1"));
  CHECK_THROWS_WITH(read({"simulation.contact=velocty"}), Contains("velocity"));
  CHECK_THROWS_WITH(read({"simulation.contact=velocity", "simulation.integrator=bdf2"}),
                    Contains("simulation.contact") && Contains("bdf2") && Contains("symplectic-euler"));

  const auto warned = [&](const std::vector<std::string>& words) {
    for (const std::string& message : make_simulation(read(words)).messages)
      if (message.find("restitution has no effect") != message.npos) return true;
    return false;
  };
  CHECK(warned({"obstacle.ball.restitution=0.4"}));
  CHECK_FALSE(warned({"obstacle.ball.restitution=0.4", "simulation.contact=restitution"}));
  CHECK_FALSE(warned({}));
}

TEST_CASE("a step with a response allocates nothing", "[response]") {
  if (!counts_allocations()) return;
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
    const TriangleMesh mesh = grid(11, 11, 0.3, 0.3);
    System system(lumped_mass(mesh, 0.3));
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Sphere{{0, -0.105, 0}, 0.1}, .restitution = 0.3});
    constraints.add(Obstacle{.shape = Plane{{0, -0.01, 0}, {0, 1, 0}}, .restitution = 0.3});
    State state = at_rest(mesh);
    auto stepper = make_integrator("symplectic-euler", system, constraints, make_linear_solver("mpcg"),
                                   StepOptions{.contact = mode});
    for (int n = 0; n < 200; ++n) REQUIRE(stepper->advance(state, 4e-4).done);
    const long before = allocations();
    int contacts = 0;
    for (int n = 0; n < 50; ++n) contacts += stepper->advance(state, 4e-4).contacts;
    const long made = allocations() - before;
    CHECK(contacts > 50);
    CHECK(made == 0);
  }
}
