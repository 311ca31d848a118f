// Contact and friction: single particles against closed forms, cloths against every shape.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "solver/forces/woven.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

// One free particle of 10 g among obstacles.
struct Particle {
  System system{{0.01}};
  Constraints constraints;
  State state{0, VecX::Zero(3), VecX::Zero(3)};
  ImplicitEuler stepper{system, constraints, make_linear_solver("mpcg")};

  explicit Particle(const Vec3& g = {0, -9.81, 0}) { system.add(Gravity{g}); }
  StepReport step(double h = 0.01) { return stepper.advance(state, h); }
};

Plane incline(double angle) { return {Vec3::Zero(), {std::sin(angle), std::cos(angle), 0}}; }

struct Cloth {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;
  ImplicitEuler stepper;

  Cloth(TriangleMesh m, const Fabric& fabric, const Vec3& lift)
      : mesh(std::move(m)),
        system(masses(mesh, fabric)),
        state(at_rest(mesh)),
        stepper(system, constraints, make_linear_solver("mpcg")) {
    for (int i = 0; i < state.particles(); ++i) state.x.segment<3>(3 * i) += lift;
    system.add(noh_jung(mesh, fabric));
    system.add(Gravity{});
  }
  double deepest() const {
    const auto depth = constraints.penetration(state.x);
    return *std::max_element(depth.begin(), depth.end());
  }
};

Fabric soft() { return {.area_density = 0.2, .stretch = 300, .bend = 1e-5, .damping = 5e-3}; }

MeshBody body(TriangleMesh mesh, const Vec3& at = Vec3::Zero()) {
  for (Vec3& p : mesh.positions) p += at;
  return std::make_shared<SurfaceDistance>(mesh);
}

}  // namespace

TEST_CASE("an incline holds below tan(theta) = mu and lets go above", "[contact]") {
  const double mu = 0.4;
  for (double factor : {0.999, 1.001}) {
    const double angle = std::atan(mu * factor);
    Particle p;
    p.constraints.add(Obstacle{.shape = incline(angle), .friction = mu, .margin = 0});
    for (int n = 0; n < 300; ++n) p.step();
    const double speed = p.state.v.norm();
    INFO(factor);
    if (factor < 1) {
      CHECK(speed < 1e-6);
      CHECK(p.state.x.norm() < 1e-9);
    } else {
      const double expected = 9.81 * (std::sin(angle) - mu * std::cos(angle)) * 3;
      CHECK(speed == Approx(expected).epsilon(0.02));
      CHECK(p.state.v[0] > 0);  // downhill
    }
  }
}

TEST_CASE("a sheet on an incline holds to 0.999 mu within a micrometre, and slides from 1.001 mu",
          "[contact]") {
  // It is laid on, or dropped from 1 mm; what the landing took is no creep.
  const double mu = 0.3, h = 0.01, g = 9.81;
  const Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-5};
  const TriangleMesh mesh = grid(7, 7, 0.3, 0.3);
  for (const char* integrator : {"implicit-euler", "bdf2"}) {
    for (const bool of_springs : {false, true}) {
      for (const double lift : {0.0, 1e-3}) {
        for (const double factor : {0.985, 0.999, 1.001}) {
          const double angle = std::atan(mu * factor);
          const Plane plane = incline(angle);
          const Vec3 down(std::cos(angle), -std::sin(angle), 0);
          System system(lumped_mass(mesh, fabric.area_density));
          system.add(of_springs ? noh_jung(mesh, fabric) : woven(mesh, mesh, fabric));
          system.add(Gravity{});
          Constraints constraints;
          constraints.add(Obstacle{.shape = plane, .friction = mu});
          State state = at_rest(mesh);
          state.x = moved_rigidly(state.x, rotation(-angle, {0, 0, 1}), (2e-3 + lift) * plane.normal);
          auto stepper =
              make_integrator(integrator, system, constraints, make_linear_solver("mpcg+block-ic0"), {});
          const auto advance = [&](double duration) {
            for (int n = 0; n < static_cast<int>(std::lround(duration / h)); ++n)
              REQUIRE(stepper->advance(state, h).done);
          };
          const auto mean_speed = [&] {
            double sum = 0;
            for (int i = 0; i < state.particles(); ++i) sum += state.v.segment<3>(3 * i).dot(down);
            return sum / state.particles();
          };
          INFO(integrator << (of_springs ? ", noh-jung, " : ", woven, ") << lift << " m, " << factor
                          << " mu");
          advance(0.5);
          const VecX landed = state.x;
          const double before = mean_speed();
          if (factor < 1) {
            advance(10);
            CHECK((state.x - landed).cwiseAbs().maxCoeff() < 1e-9);
            CHECK(max_speed(state) < 1e-9);
          } else {
            advance(5);
            const double a = g * (std::sin(angle) - mu * std::cos(angle));
            // Springs that push each other aside are rubbed aside, too, and so less against the way down.
            CHECK(mean_speed() - before ==
                  Approx(5 * a).epsilon(0.05).margin(of_springs ? 5 * 2e-3 * mu * g : 0));
          }
        }
      }
    }
  }
}

TEST_CASE("what rests on a moving incline keeps its place on it", "[contact]") {
  // A mesh that goes up and to the side, steadily, at 0.999 mu.
  const double mu = 0.3, angle = std::atan(0.999 * mu), h = 0.01;
  TriangleMesh slab = box({2, 0.1, 2});
  for (Vec3& x : slab.positions) x = rotation(-angle, {0, 0, 1}) * (x - Vec3(0, 0.05, 0));
  const Vec3 carried(0.2, 0.1, -0.3), normal = incline(angle).normal;  // m/s
  for (const char* integrator : {"implicit-euler", "bdf2"}) {
    System system({0.01});
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = body(slab),
                             .friction = mu,
                             .motion = Motion::constant(carried, Vec3::Zero(), Vec3::Zero())});
    State state{0, VecX(2e-3 * normal), VecX(carried)};
    auto stepper = make_integrator(integrator, system, constraints, make_linear_solver("mpcg"), {});
    for (int n = 0; n < 200; ++n) REQUIRE(stepper->advance(state, h).done);
    INFO(integrator);
    CHECK((state.x - 2e-3 * normal - state.time * carried).norm() < 1e-9);
  }
}

TEST_CASE("what slides slowly stops as friction stops it, and no later", "[contact]") {
  // Close to the angle of friction that takes long; on the level it is done within one step.
  const double mu = 0.3, h = 0.01, v0 = 0.01;
  for (const double factor : {0.0, 0.9, 0.985}) {
    const double angle = std::atan(mu * factor);
    Particle p;
    p.constraints.add(Obstacle{.shape = incline(angle), .friction = mu, .margin = 0});
    p.state.v = v0 * Vec3(std::cos(angle), -std::sin(angle), 0);
    const double a = 9.81 * (mu * std::cos(angle) - std::sin(angle));
    double stopped = 0;
    for (int n = 0; n < 100; ++n) {
      p.step(h);
      if (stopped == 0 && p.state.v.norm() < 1e-12) stopped = p.state.time;
    }
    INFO(factor);
    CHECK(stopped == Approx(v0 / a).margin(2 * h));
    CHECK(p.state.x.norm() == Approx(v0 * v0 / (2 * a)).margin(v0 * h));
    CHECK(p.state.v.norm() < 1e-12);
  }
}

TEST_CASE("sliding goes with g (sin - mu cos)", "[contact]") {
  for (double mu : {0.0, 0.2, 0.5}) {
    const double angle = 0.7;
    Particle p;
    p.constraints.add(Obstacle{.shape = incline(angle), .friction = mu});
    const Vec3 n(std::sin(angle), std::cos(angle), 0);
    p.state.x = 2e-3 * n;
    for (int k = 0; k < 100; ++k) p.step();
    CHECK(p.state.v.norm() == Approx(9.81 * (std::sin(angle) - mu * std::cos(angle))).epsilon(1e-3));
    CHECK(std::abs(n.dot(p.state.x) - 2e-3) < 1e-12);  // on the offset surface
  }
}

TEST_CASE("static friction above kinetic holds longer and slides faster", "[contact]") {
  const double angle = 0.35;  // tan = 0.365
  Particle held, pushed;
  for (Particle* p : {&held, &pushed})
    p->constraints.add(Obstacle{.shape = incline(angle), .friction = {0.5, 0.2}, .margin = 0});
  pushed.state.v = Vec3(std::cos(angle), -std::sin(angle), 0) * 0.5;
  for (int k = 0; k < 100; ++k) {
    held.step();
    pushed.step();
  }
  CHECK(held.state.v.norm() < 1e-9);
  CHECK(pushed.state.v.norm() ==
        Approx(0.5 + 9.81 * (std::sin(angle) - 0.2 * std::cos(angle))).epsilon(0.01));
}

TEST_CASE("a sliding particle stops after v^2 / (2 mu g), and stays", "[contact]") {
  const double mu = 0.3, v0 = 2, h = 0.002;
  Particle p;
  p.constraints.add(Obstacle{.shape = Plane{}, .friction = mu, .margin = 0});
  p.state.v = Vec3(v0, 0, 0);
  double stopped = 0;
  for (int k = 0; k < 600; ++k) {
    p.step(h);
    CHECK(p.state.v[0] > -1e-12);  // friction never turns the motion round
    if (stopped == 0 && p.state.v.norm() < 1e-6) stopped = p.state.time;
  }
  CHECK(stopped == Approx(v0 / (mu * 9.81)).margin(5 * h));
  CHECK(p.state.x[0] == Approx(v0 * v0 / (2 * mu * 9.81)).margin(1.5 * h * v0));
  CHECK(p.state.v.norm() < 1e-12);
}

TEST_CASE("the constraint pushes and never pulls", "[contact]") {
  // Lifted off by a force away from the plane, after it has come to rest on it.
  Particle p;
  p.constraints.add(Obstacle{.shape = Plane{}});
  p.state.x[1] = 0.05;
  for (int k = 0; k < 50; ++k) p.step();
  CHECK(p.state.x[1] == Approx(2e-3).margin(1e-9));
  CHECK(p.state.v.norm() < 1e-9);
  Particle lifted({0, 4, 0});
  lifted.constraints.add(Obstacle{.shape = Plane{}});
  lifted.state = p.state;
  for (int n = 1; n <= 20; ++n) {
    lifted.step();
    // Free fall, upwards.
    CHECK(lifted.state.x[1] == Approx(2e-3 + 4 * 1e-4 * n * (n + 1) / 2).epsilon(1e-9));
  }
}

TEST_CASE("a falling particle lands on the offset surface, at any speed", "[contact]") {
  for (double v : {0.5, 5.0, 50.0, 500.0}) {
    Particle p;
    p.constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, 0.3}});
    p.state.x = Vec3(0, 1, 0);
    p.state.v = Vec3(0, -v, 0);
    for (int k = 0; k < 200; ++k) p.step();
    INFO(v << " m/s");
    CHECK(p.state.x[1] == Approx(0.302).margin(1e-9));
  }
}

TEST_CASE("what hovers over a body, held up by the cloth, is not caught", "[contact]") {
  Chain chain(8, 0.5, 0.05, 200, {0, -1, 0});
  chain.system.add(Gravity{});
  chain.constraints.pin(0);
  ImplicitEuler stepper(chain.system, chain.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-10});
  for (int k = 0; k < 400; ++k) stepper.advance(chain.state, 0.01);
  REQUIRE(max_speed(chain.state) < 1e-6);
  const double lowest = chain.state.x[3 * 8 + 1];
  // Half as far over the plane's margin as it would fall in one step, were it free.
  const Obstacle floor{.shape = Plane{{0, lowest - 0.5e-3 - 2e-3, 0}, {0, 1, 0}}, .margin = 2e-3};
  chain.constraints.add(floor);
  for (int k = 0; k < 20; ++k) {
    const StepReport report = stepper.advance(chain.state, 0.01);
    CHECK(report.contacts == 0);
    CHECK(report.linear_solves <= 2);  // a loose one, and one to the tolerance: no contact changed
  }
  CHECK(max_speed(chain.state) < 1e-6);
}

TEST_CASE("nothing tunnels through thin things", "[contact]") {
  const TriangleMesh sheet = grid(5, 5, 1, 1);  // an open surface: thick by its margin only
  const std::vector<Shape> thin = {Box{{0, 0, 0}, {1, 1e-3, 1}}, Capsule{{-1, 0, 0}, {1, 0, 0}, 1e-3},
                                   Bowl{{0, 0.2, 0}, 0.2, 1e-3}, body(sheet)};
  for (const Shape& shape : thin) {
    for (double v : {1.0, 10.0, 100.0}) {
      Particle p;
      p.constraints.add(Obstacle{.shape = shape, .friction = 0.5});
      p.state.x = Vec3(0.001, 0.3, 0);
      p.state.v = Vec3(0, -v, 0);
      double lowest = 1;
      for (int k = 0; k < 40; ++k) {
        p.step();
        lowest = std::min(lowest, p.state.x[1]);
      }
      INFO(name(shape) << " at " << v << " m/s");
      if (!std::holds_alternative<Capsule>(shape)) CHECK(lowest > -1e-4);  // it may slide off a rod
    }
  }
}

TEST_CASE("a particle in a corner is held by both walls", "[contact]") {
  Particle p({-3, -9.81, 0});
  p.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.0, .margin = 0});
  p.constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, {1, 0.2, 0}}, .friction = 0.0, .margin = 0});
  p.state.x = Vec3(0.3, 0.2, 0);
  p.state.v = Vec3(0, 0, 0.1);
  for (int k = 0; k < 200; ++k) p.step();
  CHECK(p.state.x.head<2>().norm() < 1e-9);
  CHECK(p.state.v[2] == Approx(0.1));  // free along the edge
}

TEST_CASE("friction in a groove is mu of what both walls bear, in the step of the landing and after it",
          "[contact]") {
  // Each wall bears m (w + g h) / (2 cos a) when it lands with w [m/s], and m g h / (2 cos a) in other steps.
  const double mu = 0.2, g = 9.81, h = 0.005, w = 1, u = 5;
  for (const double between : {60.0, 90.0, 120.0}) {  // degrees from one wall's normal to the other's
    INFO(between);
    const double a = between / 2 * M_PI / 180;
    Particle p;
    for (const double side : {-1.0, 1.0})
      p.constraints.add(
          Obstacle{.shape = Plane{{0, 0, 0}, {side * std::sin(a), std::cos(a), 0}}, .friction = mu});
    p.state.x = Vec3(0, 0.002 / std::cos(a) + 1e-9, 0);
    p.state.v = Vec3(0, -w, u);
    for (int n = 1; n <= 40; ++n) {
      p.step(h);
      CHECK(p.state.v[2] == Approx(u - mu * (w + g * h * n) / std::cos(a)).margin(1e-6));
      CHECK(p.state.v.head<2>().norm() < 1e-6);
    }
  }
}

TEST_CASE("a wall that is let go bears nothing, and friction forgets it", "[contact]") {
  // The path meets both planes, but what the floor stops moves away from the wall: only the floor bears.
  const double mu = 0.2, g = 9.81, h = 0.005;
  Particle p;
  p.constraints.add(Obstacle{.shape = Plane{}, .friction = mu});
  p.constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, {std::sqrt(0.75), 0.5, 0}}, .friction = mu});
  p.state.x = Vec3(0.002 * (1 - 0.5) / std::sqrt(0.75) + 1e-9, 0.002 + 1e-9, 0);
  p.state.v = Vec3(0.4, -1, 5);
  const double start = std::hypot(0.4, 5);
  for (int n = 1; n <= 40; ++n) {
    const StepReport report = p.step(h);
    if (n == 1) CHECK(report.linear_solves > 2);  // the wall was held first
    const Vec3 v = p.state.v;
    CHECK(std::abs(v[1]) < 1e-6);
    CHECK(v.norm() == Approx(start - mu * (1 + g * h * n)).margin(1e-6));
    CHECK(v[0] / v[2] == Approx(0.4 / 5).epsilon(1e-3));
  }
}

TEST_CASE("a particle that is put elsewhere meets what is there", "[contact]") {
  Particle p;
  p.constraints.add(Obstacle{.shape = Plane{}});
  p.state.x = Vec3(0, 1, 0);
  p.step(0.01);
  p.state.x = Vec3(0, 0.003, 0);  // by hand: a metre nearer than it was
  p.state.v = Vec3(0, -3, 0);
  p.step(0.01);
  CHECK(p.state.x[1] >= 0.002 - 1e-9);
}

TEST_CASE("a cloth laid on a plane comes to rest and stays", "[contact]") {
  Cloth cloth(grid(12, 12, 0.5, 0.5), soft(), {0, 0.02, 0});
  cloth.constraints.add(Obstacle{.shape = Plane{}});
  for (int k = 0; k < 100; ++k) REQUIRE(cloth.stepper.advance(cloth.state, 0.01).done);
  for (int k = 0; k < 100; ++k) {
    cloth.stepper.advance(cloth.state, 0.01);
    CHECK(max_speed(cloth.state) < 1e-3);
  }
  CHECK(cloth.deepest() == 0);
}

TEST_CASE("a cloth draped over any shape never goes in, and comes to rest", "[contact]") {
  const std::vector<Shape> shapes = {Sphere{{0, 0, 0}, 0.15},
                                     Box{{0, 0, 0}, {0.3, 0.2, 0.3}, rotation(0.5, {0, 1, 0})},
                                     Capsule{{-0.1, 0, 0}, {0.1, 0.05, 0}, 0.08},
                                     Bowl{{0, 0.2, 0}, 0.35, 0.01},
                                     body(sphere(3, 0.15)),
                                     body(tube(24, 8, 0.12, 0.3))};  // open: a thick surface
  for (const Shape& shape : shapes) {
    Cloth cloth(grid(17, 17, 0.5, 0.5), soft(), {0.01, 0.22, 0.02});
    cloth.constraints.add(Obstacle{.shape = shape, .friction = 0.5});
    cloth.constraints.add(Obstacle{.shape = Plane{{0, -0.3, 0}, {0, 1, 0}}, .friction = 0.5});
    double deepest = 0;
    for (int k = 0; k < 400; ++k) {
      const StepReport report = cloth.stepper.advance(cloth.state, 0.01);
      REQUIRE(report.done);
      deepest = std::max(deepest, cloth.deepest());
    }
    INFO(name(shape) << ": deepest " << deepest << " m, speed " << max_speed(cloth.state));
    CHECK(deepest < 1e-6);
    CHECK(max_speed(cloth.state) < 0.05);
  }
}

TEST_CASE("a cloth that starts inside a body is brought out smoothly", "[contact]") {
  Cloth cloth(grid(11, 11, 0.4, 0.4), soft(), {0, 0.17, 0});  // the middle is 3 cm deep
  cloth.constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, 0.2}, .friction = 0.3});
  CHECK(cloth.deepest() == Approx(0.03));
  const double energy = cloth.system.gravity_energy(cloth.state.x);
  double fastest = 0, before = cloth.deepest();
  for (int k = 0; k < 40; ++k) {
    const StepReport report = cloth.stepper.advance(cloth.state, 0.01);
    REQUIRE(report.done);
    fastest = std::max(fastest, max_speed(cloth.state));
    CHECK(cloth.deepest() <= before + 1e-9);
    before = cloth.deepest();
    if (k == 2) CHECK(before > 0.01);  // not in one jump
  }
  CHECK(before < 1e-9);
  CHECK(fastest < 3.0);  // no explosion: of the order of a fall
  CHECK(cloth.system.gravity_energy(cloth.state.x) < energy + 0.05);
}

TEST_CASE("pins select by number, box and group, and say when they select nothing", "[contact]") {
  TriangleMesh mesh = grid(3, 3, 1, 1);
  mesh.groups = {{"hem", {6, 7, 8}}};
  CHECK(select(PinVertices{{4, 0, 4}}, mesh) == std::vector<int>{0, 4});
  CHECK(select(PinBox{{-1, -1, -1}, {1, 1, -0.4}}, mesh) == std::vector<int>{0, 1, 2});
  CHECK(select(PinGroup{"hem"}, mesh) == std::vector<int>{6, 7, 8});
  CHECK_THROWS_WITH(select(PinVertices{{9}}, mesh), Catch::Contains("vertex 9") && Catch::Contains("0 to 8"));
  CHECK_THROWS_WITH(select(PinVertices{{}}, mesh), Catch::Contains("empty"));
  CHECK_THROWS_WITH(select(PinBox{{5, 5, 5}, {6, 6, 6}}, mesh), Catch::Contains("holds no vertex"));
  CHECK_THROWS_WITH(select(PinGroup{"collar"}, mesh), Catch::Contains("collar") && Catch::Contains("hem"));
}

TEST_CASE("pinned and massless particles do not move", "[contact]") {
  Cloth cloth(grid(5, 5, 1, 1), soft(), Vec3::Zero());
  cloth.constraints.pin({0, 4});
  const State start = cloth.state;
  for (int k = 0; k < 30; ++k) cloth.stepper.advance(cloth.state, 0.01);
  CHECK((cloth.state.x.segment<3>(0) - start.x.segment<3>(0)).norm() == 0);
  CHECK((cloth.state.x.segment<3>(12) - start.x.segment<3>(12)).norm() == 0);
  CHECK(cloth.state.x[3 * 24 + 1] < -0.1);
}

TEST_CASE("an obstacle that makes no sense is refused", "[contact]") {
  Constraints constraints;
  CHECK_THROWS_AS(constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, -1}}), InputError);
  CHECK_THROWS_AS(constraints.add(Obstacle{.shape = Plane{}, .friction = -0.1}), InputError);
  CHECK_THROWS_AS(constraints.add(Obstacle{.shape = Plane{}, .friction = {0.1, 0.2}}), InputError);
  CHECK_THROWS_AS(constraints.add(Obstacle{.shape = Plane{}, .margin = -1}), InputError);
}

TEST_CASE("a contact may change its mind, and comes to a decision within a step", "[contact]") {
  // Solves that contradict it for ever: held, it rubs more than friction can bear;
  // let loose, friction drives it.
  Constraints constraints;
  constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 0.001});
  for (int step = 0; step < 2; ++step) {
    const VecX x = Vec3(0, 0.0009, 0);
    ContactStep contacts = constraints.begin_step(x, VecX::Zero(3), {1.0}, 0, 0.01);
    int changes = 0;
    for (int round = 0; round < 50; ++round)
      changes += contacts.react(VecX(Vec3(-1, 0, 0)), VecX(Vec3(-10, 1, 0)), x, 0).any();
    CHECK(changes >= 2);
    CHECK(changes <= 10);
  }
}

TEST_CASE("nothing sticks where there is no friction, also what does not slide", "[contact]") {
  System system(std::vector<double>{0.01});
  system.add(gravity({0, -9.81, 0}));
  Constraints constraints;
  constraints.add(Obstacle{.shape = Plane{}, .friction = 0.0});
  const auto stepper = make_integrator("implicit-euler", system, constraints, make_linear_solver("mpcg"));
  State state{0, stacked({Vec3(0, 0.001, 0)}), VecX::Zero(3)};
  for (int step = 0; step < 20; ++step) {
    REQUIRE(stepper->advance(state, 0.01).done);
    for (const Contact& c : constraints.contacts()) CHECK(c.grip != Grip::stick);
  }
  CHECK(constraints.contacts().size() == 1);
}
