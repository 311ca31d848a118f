// Bodies with mass meet each other and bodies that stand or are led: rest, friction, impact, stacks, and
// together with cloth. Every law is asked of a list of shapes, in steps of three lengths where it is physics.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "constraints/contact_step.h"
#include "tests/integrators.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81, gap = BodyMeeting::rest_gap;

// Bodies alone, without cloth.
struct World {
  Constraints constraints;
  State state;
  ContactReport report;
  double time = 0;

  int add(const Shape& shape, double mass, double mu = 0.5, double e = 0) {
    Obstacle obstacle{.shape = shape, .friction = mu, .restitution = e};
    if (mass > 0) {
      const UniformSolid solid = uniform_solid(shape, mass).value();
      obstacle.rigid = RigidBody{.mass = mass, .inertia = solid.inertia, .centre = solid.centre};
    }
    return add(obstacle);
  }
  int add(const Obstacle& obstacle) {
    constraints.add(obstacle);
    return static_cast<int>(constraints.bodies().size()) - 1;
  }
  void step(double h) {
    ContactStep contacts = constraints.begin_step(state.x, state.v, {}, time, h);
    do {
      contacts.receive(state.v, state.v, state.x);
    } while (contacts.move_bodies(0));
    report = contacts.finish(state.x, state.v);
    REQUIRE(report.converged);
    time += h;
  }
  void run(double until, double h) {
    while (time < until - h / 2) step(h);
  }
  const ReactingBody& body(int k) const {
    return *constraints.bodies()[static_cast<std::size_t>(k)].reacting();
  }
  double lowest(int k, const std::vector<Vec3>& points) const {
    double y = std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) y = std::min(y, body(k).pose().to_world(p)[1]);
    return y;
  }
};

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double energy = 0;
};
Momenta momenta(const World& world) {
  Momenta all;
  for (const MovingBody& moving : world.constraints.bodies()) {
    const ReactingBody* const body = moving.reacting();
    if (!body) continue;
    all.linear += body->momentum();
    all.angular += body->centre().cross(body->momentum()) + body->angular_momentum();
    all.energy += body->momentum().dot(body->velocity()) / 2 + body->angular_momentum().dot(body->spin()) / 2;
  }
  return all;
}

TriangleMesh placed(TriangleMesh mesh, const Mat3& R, const Vec3& t) {
  for (Vec3& p : mesh.positions) p = R * p + t;
  return mesh;
}

struct Named {
  const char* name;
  Shape shape;
  double flat;  // where its middle is when it lies on its flat side on y = 0 [m]
};

// Bodies about 20 cm large, of every kind that can react but the level set, whose points rock, that stand at
// y = `height` on their flat side.
std::vector<Named> kinds(double height) {
  const Vec3 c(0, height, 0), size(0.2, 0.15, 0.3);
  const TriangleMesh cube = placed(box_mesh(size), Mat3::Identity(), c);
  return {{"box", Box{.centre = c, .size = size}, 0.075},
          {"sphere", Sphere{c, 0.1}, 0.1},
          {"capsule", Capsule{c - Vec3(0.1, 0, 0), c + Vec3(0.1, 0, 0), 0.05}, 0.05},
          {"plate", Plate{.centre = c, .radius = 0.1, .height = 0.04, .rim = 0.01}, 0.02},
          {"mesh", body(cube), 0.075}};
}

std::vector<Named> grounds() {
  const TriangleMesh slab = placed(box_mesh({2, 0.2, 2}), Mat3::Identity(), {0, -0.1, 0});
  return {{"plane", Plane{}, 0},
          {"box", Box{.centre = {0, -0.1, 0}, .size = {2, 0.2, 2}}, 0},
          {"plate", Plate{.centre = {0, -0.1, 0}, .radius = 1, .height = 0.2}, 0},
          {"mesh", body(slab), 0}};
}

Mat3 about_z(double a) { return Eigen::AngleAxisd(a, Vec3::UnitZ()).toRotationMatrix(); }

}  // namespace

TEST_CASE("a body of any kind comes to rest on a ground of any kind, and stays", "[meeting]") {
  for (const Named& ground : grounds())
    for (const Named& kind : kinds(0.25)) {
      INFO(kind.name << " on a " << ground.name);
      World world;
      world.add(ground.shape, 0);
      const int k = world.add(kind.shape, 2);
      world.run(1.5, 0.01);
      const Vec3 c = world.body(k).centre();
      CHECK(c[1] == Approx(kind.flat + gap).margin(1e-5));
      world.run(3, 0.01);
      CHECK((world.body(k).centre() - c).norm() < 1e-6);
      CHECK(world.body(k).velocity().norm() < 1e-6);
      CHECK(world.body(k).spin().norm() < 1e-5);
      CHECK(world.report.body_contacts > 0);
      // What it rests on bears its weight.
      CHECK((world.body(k).impulse_of_bodies() - Vec3(0, 2 * g * 0.01, 0)).norm() < 1e-5 * 2 * g * 0.01);
    }
}

TEST_CASE("a tilted box falls on a corner, tumbles and comes to rest without making energy", "[meeting]") {
  for (double h : {0.01, 0.005, 0.0025}) {
    INFO("step " << h << " s");
    World world;
    world.add(Plane{}, 0);
    const int k = world.add(
        Box{.centre = {0, 0.5, 0}, .size = {0.2, 0.15, 0.3}, .rotation = rotation(0.6, {1, 0.3, 0.2})}, 1);
    double energy = g * world.body(k).centre()[1];
    const double start = energy;
    while (world.time < 4) {
      world.step(h);
      const double now = momenta(world).energy + g * world.body(k).centre()[1];
      CHECK(now < energy + 1e-3);
      CHECK(now < start + 1e-2);
      energy = now;
      CHECK(world.report.body_overlap < 0.02 * 0.1);
    }
    CHECK(world.body(k).velocity().norm() < 1e-6);
    CHECK(world.body(k).centre()[1] == Approx(0.075).margin(1e-5));
  }
}

TEST_CASE("on an incline a body sticks below the angle of friction and slides above it", "[meeting]") {
  const double mu = 0.45;
  for (double degrees : {10.0, 22.0, 26.0, 40.0})
    for (double h : {0.01, 0.005, 0.0025})
      for (int kind : {0, 3, 4}) {  // those that do not roll
        const double a = degrees * std::numbers::pi / 180;
        const Mat3 R = about_z(a);
        World world;
        world.add(Plane{.normal = R * Vec3::UnitY()}, 0, mu);
        const Named lying = kinds(0)[static_cast<std::size_t>(kind)];
        INFO(lying.name << " at " << degrees << " degrees, step " << h << " s");
        Obstacle obstacle{.shape = lying.shape, .friction = mu};
        const UniformSolid solid = uniform_solid(lying.shape, 1).value();
        obstacle.rigid = RigidBody{.mass = 1, .inertia = solid.inertia, .centre = solid.centre};
        obstacle.motion = Motion::keyframes(
            {{.time = 0, .translate = R * Vec3(0, lying.flat + gap, 0), .rotation = {0, 0, a}}},
            Vec3::Zero());
        const int k = world.add(obstacle);
        const Vec3 start = world.body(k).centre();
        world.run(0.5, h);
        const double pull = g * (std::sin(a) - mu * std::cos(a));
        if (pull < 0)
          CHECK((world.body(k).centre() - start).norm() < 1e-9);
        else
          CHECK(world.body(k).velocity().norm() == Approx(0.5 * pull).epsilon(0.01));
      }
}

TEST_CASE("a ball that falls rises again to the square of the restitution", "[meeting]") {
  const double fall = 0.5;  // m
  for (const Named& ground : grounds())
    for (double e : {0.0, 0.5, 0.8})
      for (double h : {4e-3, 2e-3, 1e-3}) {
        INFO("on a " << ground.name << ", e = " << e << ", step " << h << " s");
        World world;
        world.add(ground.shape, 0, 0.5, e);
        const int k = world.add(Sphere{{0, 0.1 + fall, 0}, 0.1}, 1, 0.5, e);
        double rebound = 0;
        bool fell = false;
        while (world.time < 0.9) {
          world.step(h);
          fell = fell || world.body(k).velocity()[1] >= 0;
          if (fell && world.body(k).velocity()[1] < -1) break;  // comes down again
          if (fell) rebound = std::max(rebound, world.body(k).centre()[1] - 0.1);
        }
        CHECK(rebound == Approx(e * e * fall).margin(1.5 * h * std::sqrt(2 * g * fall)));
      }
}

TEST_CASE("two bodies that collide keep both momenta, and part at the restitution", "[meeting]") {
  const auto of_all = kinds(0);
  for (const Named& one : of_all)
    for (const Named& other : of_all)
      for (double e : {0.0, 0.6, 1.0})
        for (const Vec3& beside : {Vec3(0, 0, 0), Vec3(0, 0.02, 0.03)}) {
          INFO(one.name << " against " << other.name << ", e = " << e << ", beside by " << beside.norm());
          World world;
          const auto throw_in = [&](const Named& kind, double mass, const Vec3& at, const Vec3& v,
                                    const Vec3& w) {
            Obstacle o{.shape = kind.shape, .friction = 0.3, .restitution = e};
            const UniformSolid solid = uniform_solid(kind.shape, mass).value();
            o.rigid = RigidBody{mass, solid.inertia, solid.centre, v, w, Vec3::Zero()};
            o.motion = Motion::keyframes({{.translate = at}}, Vec3::Zero());
            world.add(o);
          };
          throw_in(one, 1, {-0.3, 0, 0}, {2, 0, 0}, Vec3::Zero());
          throw_in(other, 3, Vec3(0.3, 0, 0) + beside, {-1, 0, 0},
                   beside.isZero() ? Vec3(0, 0, 0) : Vec3(1, 2, 0));
          const Momenta before = momenta(world);
          double energy = before.energy;
          while (world.time < 0.4) {
            world.step(0.002);
            const Momenta now = momenta(world);
            // A body that spins freely changes its energy by the square of the turn in a step, and an impact
            // by the turn.
            CHECK(now.energy < energy * 1.03);
            CHECK(now.energy < before.energy * 1.1);
            energy = now.energy;
          }
          const Momenta after = momenta(world);
          CHECK((after.linear - before.linear).norm() < 1e-13);
          // Bodies that stay together turn into each other a little: what moves them apart shifts their
          // centres.
          CHECK((after.angular - before.angular).norm() < (e > 0 ? 1e-12 : 0.01));
          CHECK(world.body(0).velocity()[0] < 1.5);  // they met
          const bool round =
              one.shape.index() == other.shape.index() && std::holds_alternative<Sphere>(one.shape);
          if (round && beside.isZero())
            CHECK(world.body(1).velocity()[0] - world.body(0).velocity()[0] == Approx(3 * e).margin(1e-9));
        }
}

TEST_CASE("a stack of three boxes comes to rest and stays, also under a heavy one", "[meeting]") {
  for (double heavy : {1.0, 10.0})
    for (bool mesh : {false, true})
      for (double h : {0.01, 0.005, 0.0025}) {
        INFO("masses 1 : 1 : " << heavy << (mesh ? ", meshes" : ", boxes") << ", step " << h << " s");
        World world;
        world.add(Plane{}, 0);
        for (int k = 0; k < 3; ++k) {
          const Vec3 c(0.01 * k, 0.11 + 0.22 * k, 0.02 * k);
          const Vec3 size(0.2, 0.2, 0.2);
          if (mesh)
            world.add(body(placed(box_mesh(size), Mat3::Identity(), c)), k == 2 ? heavy : 1);
          else
            world.add(Box{.centre = c, .size = size}, k == 2 ? heavy : 1);
        }
        world.run(1, h);
        std::vector<Vec3> places;
        for (int k = 1; k <= 3; ++k) {
          CHECK(world.body(k).velocity().norm() < 1e-4);
          places.push_back(world.body(k).centre());
          CHECK(places.back()[1] == Approx(0.2 * k - 0.1).margin(1e-5));
        }
        while (world.time < 3) {
          world.step(h);
          CHECK(world.body(3).velocity().norm() < 1e-4);
        }
        for (int k = 1; k <= 3; ++k)
          CHECK((world.body(k).centre() - places[static_cast<std::size_t>(k - 1)]).norm() < 1e-6);
      }
}

TEST_CASE("a ball that slides ends by rolling with 5/7 of its speed", "[meeting]") {
  for (const Named& ground : grounds())
    for (double h : {0.01, 0.005, 0.0025}) {
      INFO("on a " << ground.name << ", step " << h << " s");
      World world;
      world.add(ground.shape, 0, 0.3);
      Obstacle ball{.shape = Sphere{{-0.5, 0.1 + gap, 0}, 0.1}, .friction = 0.3};
      ball.rigid = RigidBody{.mass = 1,
                             .inertia = 0.004 * Mat3::Identity(),
                             .centre = {-0.5, 0.1 + gap, 0},
                             .velocity = {1, 0, 0}};
      const int k = world.add(ball);
      world.run(0.6, h);
      CHECK(world.body(k).velocity()[0] == Approx(5.0 / 7).epsilon(1e-4));
      CHECK(world.body(k).spin()[2] == Approx(-5.0 / 7 / 0.1).epsilon(1e-4));
    }
}

TEST_CASE("what stands on a table goes with it where friction holds, and stays behind where it does not",
          "[meeting]") {
  for (double mu : {0.05, 0.8}) {
    INFO("mu " << mu);
    World world;
    Obstacle table{.shape = Box{.centre = {0, -0.05, 0}, .size = {2, 0.1, 2}}, .friction = mu};
    table.motion = Motion::keyframes({{.time = 0.1}, {.time = 1.1, .translate = {0.5, 0, 0}}}, Vec3::Zero());
    world.add(table);
    const int k = world.add(Box{.centre = {0, 0.1 + gap, 0}, .size = {0.2, 0.2, 0.2}}, 1, mu);
    world.run(2, 0.01);
    if (mu > 0.5)
      CHECK((world.body(k).centre() - Vec3(0.5, 0.1 + gap, 0)).norm() < 2e-3);
    else
      CHECK(world.body(k).centre()[0] < 0.45);
  }
}
