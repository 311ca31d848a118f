// Bodies that the cloth moves: fall and spin by themselves, momentum in a collision, a ball caught in a net,
// and bodies much lighter than the cloth that they meet.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/lattice/solid.h"
#include "mesh/triangles/generate.h"
#include "solver/forces/face_contact_force.h"
#include "tests/integrators.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double h = 0.01;  // s

RigidBody ball_of(double mass, double radius, const Vec3& centre) {
  return {.mass = mass, .inertia = 0.4 * mass * radius * radius * Mat3::Identity(), .centre = centre};
}

Obstacle ball(double mass, double radius, const Vec3& centre, double mu = 0.3) {
  return {.shape = Sphere{centre, radius},
          .friction = mu,
          .margin = 3e-3,
          .rigid = ball_of(mass, radius, centre)};
}

struct Cloth {
  TriangleMesh mesh = grid(13, 13, 0.6, 0.6);
  System system{masses(mesh, fabric())};
  Constraints constraints;
  State state = at_rest(mesh);

  explicit Cloth(const Vec3& g = {0, -9.81, 0}, bool with_faces = true) {
    system.add(noh_jung(mesh, fabric()));
    system.add(Gravity{g});
    if (!with_faces) return;
    std::vector<ClothFace> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({{t[0], t[1], t[2]}, 1000});
    constraints.add_faces(faces);
    system.add(face_contact_force(constraints));
  }
  static Fabric fabric() { return {.area_density = 0.2, .stretch = 1000, .bend = 1e-5, .damping = 0.02}; }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) p += system.masses()[i] * state.v.segment<3>(3 * i);
    return p;
  }
  void pin_corners() { constraints.pin({0, 12, 156, 168}); }
  const ReactingBody& body() const { return *constraints.bodies()[0].reacting(); }
};

}  // namespace

TEST_CASE("a body that nothing touches falls, and keeps its spin", "[reacting]") {
  RigidBody brick{.mass = 2, .inertia = Vec3(0.01, 0.02, 0.025).asDiagonal(), .centre = {0.1, 0, 0}};
  brick.velocity = {1, 2, 0};
  brick.spin = {3, 0.1, 1};
  ReactingBody body(brick, {rotation(0.4, {0, 0, 1}), {0, 0, 0}});
  const Vec3 L = body.angular_momentum(), c = body.centre();
  Pose end;
  for (int n = 0; n < 100; ++n) {
    end = body.begin_step(h);
    body.clear_impulse();
    CHECK_FALSE(body.correct(end, 0));
    CHECK(body.end_step(end));
  }
  CHECK((body.velocity() - Vec3(1, 2 - 9.81, 0)).norm() < 1e-12);
  CHECK((body.centre() - c - Vec3(1, 2, 0) - Vec3(0, -9.81, 0) * h * h * 100 * 101 / 2).norm() < 1e-10);
  CHECK((body.angular_momentum() - L).norm() < 1e-14);
  CHECK((end.rotation.transpose() * end.rotation - Mat3::Identity()).norm() < 1e-12);
}

TEST_CASE("a body that tumbles freely keeps its energy, about whatever axis it began to spin", "[reacting]") {
  const Vec3 brick(0.00833, 0.01667, 0.02167), stick(1e-5, 1e-2, 1e-2);  // kg m^2
  for (const Vec3& moments : {brick, stick})
    for (const int axis : {0, 1, 2})
      for (const double speed : {3.0, 10.0, 30.0, 100.0})
        for (const double step : {0.01, 0.005, 0.0025}) {
          INFO("moments from " << moments[0] << " kg m^2, axis " << axis << ", " << speed
                               << " rad/s, steps of " << step << " s");
          const RigidBody spinning{.mass = 2,
                                   .inertia = moments.asDiagonal(),
                                   .spin = speed * (Vec3::Unit(axis) + Vec3(0.03, -0.02, 0.04)),
                                   .gravity = Vec3::Zero()};
          ReactingBody body(spinning, {rotation(0.4, {0, 0, 1}), {0, 0, 0}});
          const Vec3 L = body.angular_momentum();
          double energy = 0, most = 0;
          for (double t = 0; t < 4; t += step) {
            const Pose end = body.begin_step(step);
            const double now = 0.5 * L.dot(body.inverse_inertia() * L);  // in the middle of the step
            if (energy == 0) energy = now;
            most = std::max(most, std::abs(now / energy - 1));
            body.clear_impulse();
            REQUIRE(body.end_step(end));
          }
          CHECK((body.angular_momentum() - L).norm() < 1e-12 * L.norm());
          CHECK(most < 0.1 * std::pow(step * speed, 2));
        }
}

TEST_CASE("the solid of a box mesh has the moments of the book", "[reacting]") {
  TriangleMesh mesh = sphere(4, 0.3);
  const Solid round = solid_of(mesh);
  CHECK(round.volume == Approx(4.0 / 3 * M_PI * 0.027).epsilon(0.01));
  CHECK(round.inertia(1, 1) / round.volume == Approx(0.4 * 0.09).epsilon(0.01));
  for (Vec3& p : mesh.positions) p = rotation(0.7, {1, 2, 3}) * p + Vec3(5, -3, 2);
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);  // wound inwards
  const Solid moved = solid_of(mesh);
  CHECK(moved.volume == Approx(round.volume));
  CHECK((moved.centre - Vec3(5, -3, 2)).norm() < 1e-9);
  CHECK((moved.inertia - rotation(0.7, {1, 2, 3}) * round.inertia * rotation(0.7, {1, 2, 3}).transpose())
            .norm() < 1e-9 * round.inertia.norm());
}

TEST_CASE("the solid of a surface does not depend on how its triangles are wound or told", "[reacting]") {
  const TriangleMesh ball = sphere(3, 0.3);
  const Solid whole = solid_of(ball);
  TriangleMesh mixed = ball;
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 3)
    std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 7)
    mixed.triangles.push_back(Triangle(mixed.triangles[t]));
  TriangleMesh seamed = ball;  // its first triangle has vertices of its own
  for (int& v : seamed.triangles[0]) {
    seamed.positions.push_back(ball.positions[v]);
    v = seamed.vertex_count() - 1;
  }
  for (const TriangleMesh& mesh : {mixed, seamed}) {
    const Solid solid = solid_of(mesh);
    CHECK(solid.volume == Approx(whole.volume));
    CHECK((solid.centre - whole.centre).norm() < 1e-9);
    CHECK((solid.inertia - whole.inertia).norm() < 1e-9 * whole.inertia.norm());
  }
  TriangleMesh hollow = ball;  // its inner wall, half as large, is wound inwards
  for (const Vec3& x : ball.positions) hollow.positions.push_back(0.5 * x);
  for (Triangle t : ball.triangles) {
    for (int& v : t) v += ball.vertex_count();
    std::swap(t[0], t[1]);
    hollow.triangles.push_back(t);
  }
  CHECK(solid_of(hollow).volume == Approx(whole.volume * (1 - 0.125)));
  CHECK(solid_of(hollow).inertia(0, 0) == Approx(whole.inertia(0, 0) * (1 - 0.03125)));
}

TEST_CASE("momentum of cloth and body together is kept in a collision", "[reacting]") {
  for (const std::string& name : integrator_names())
    for (double mass : {0.02, 0.5})
      for (bool faces : {false, true}) {
        if (traits_of(name).grows_undamped) continue;
        INFO(name << " " << mass << (faces ? ", faces" : ""));
        Cloth cloth(Vec3::Zero(), faces);
        Obstacle thrown = ball(mass, 0.08, {0.03, 0.1, 0.02});
        thrown.rigid->gravity = Vec3::Zero();
        thrown.rigid->velocity = {0.3, -2, 0.1};
        cloth.constraints.add(thrown);
        auto stepper = make_integrator(name, cloth.system, cloth.constraints, make_linear_solver("mpcg"),
                                       {.tolerance = 1e-8});
        const Vec3 before = cloth.momentum() + cloth.body().momentum();
        const double step = is_explicit(name) ? 1e-4 : 2e-3;
        const int steps = static_cast<int>(std::lround(0.05 / step));
        for (int n = 0; n < steps; ++n) {
          const StepReport report = stepper->advance(cloth.state, step);
          INFO(report.failure.what);
          REQUIRE(report.done);
        }
        CHECK(cloth.body().velocity()[1] > -1.99);  // they met
        const double lost = (cloth.momentum() + cloth.body().momentum() - before).norm() /
                            (before.norm() + cloth.momentum().norm());
        CHECK(lost < traits_of(name).momentum_kept_to);
      }
}

TEST_CASE("momentum is kept, too, when a ball is fastened to the cloth and drags it along", "[reacting]") {
  for (const std::string& name : integrator_names())
    for (const auto contact : {ContactMode::constraint, ContactMode::velocity}) {
      if (traits_of(name).grows_undamped) continue;
      if (contact == ContactMode::velocity && !is_explicit(name) && !only_responds(name)) continue;
      if (contact == ContactMode::constraint && only_responds(name)) continue;
      INFO(name << " " << drape::name(contact));
      Cloth cloth(Vec3::Zero());
      const Vec3 corner = cloth.state.x.head<3>();
      Obstacle thrown = ball(0.05, 0.03, corner + Vec3(-0.04, 0, -0.04));
      thrown.rigid->gravity = Vec3::Zero();
      thrown.rigid->velocity = {-1, 0.5, -1};
      cloth.constraints.add(thrown);
      cloth.constraints.pin_to_body({0}, 0, cloth.state.x);
      auto stepper = make_integrator(name, cloth.system, cloth.constraints, make_linear_solver("mpcg"),
                                     {.tolerance = 1e-8, .contact = contact});
      const Vec3 before = cloth.body().momentum();
      const double step = is_explicit(name) ? 1e-4 : 2e-3;
      for (int n = 0; n < static_cast<int>(std::lround(0.1 / step)); ++n)
        REQUIRE(stepper->advance(cloth.state, step).done);
      CHECK(cloth.body().velocity()[0] > -0.8);
      CHECK(cloth.momentum()[0] < -0.005);
      CHECK((cloth.state.x.head<3>() - cloth.body().centre()).norm() ==
            Approx(std::hypot(0.04, 0.04)).epsilon(1e-6));
      CHECK((cloth.momentum() + cloth.body().momentum() - before).norm() <
            traits_of(name).momentum_kept_to * before.norm());
    }
}

TEST_CASE("a ball is caught by a net hung at its corners, and the pins carry its weight", "[reacting]") {
  for (double mass : {0.005, 0.02, 0.05, 0.5}) {  // the net weighs 0.072 kg
    INFO(mass);
    Cloth cloth;
    cloth.pin_corners();
    cloth.constraints.add(ball(mass, 0.08, {0.02, 0.15, 0.01}));
    ImplicitEuler stepper(cloth.system, cloth.constraints, make_linear_solver("mpcg"));
    double largest = 0;
    for (int n = 0; n < 600; ++n) {
      REQUIRE(stepper.advance(cloth.state, h).done);
      largest = std::max(largest, cloth.body().velocity().norm());
    }
    CHECK(largest < 2.6);  // it fell by at most 0.3 m, and nothing threw it faster
    CHECK(cloth.body().velocity().norm() < 0.05);
    CHECK(std::abs(cloth.body().centre()[0]) < 0.2);
    CHECK(cloth.body().centre()[1] > -0.4);
    for (double depth : cloth.constraints.penetration(cloth.state.x)) CHECK(depth == 0);
  }
}

TEST_CASE("what has no mass spoils nothing where contact is settled after the step", "[reacting]") {
  for (const std::string& name : integrator_names()) {
    INFO(name);
    TriangleMesh mesh = grid(3, 3, 0.2, 0.2);
    mesh.positions.push_back({1, 1, 1});  // of no triangle
    System system{masses(mesh, Cloth::fabric())};
    system.add(noh_jung(mesh, Cloth::fabric()));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Plane{{0, -0.003, 0}, {0, 1, 0}}});
    auto stepper =
        make_integrator(name, system, constraints, make_linear_solver("mpcg"),
                        {.contact = only_responds(name) ? ContactMode::velocity : ContactMode::constraint});
    State state = at_rest(mesh);
    for (int n = 0; n < 100; ++n) REQUIRE(stepper->advance(state, 5e-4).done);
    CHECK(state.x.allFinite());
    CHECK(state.x.tail<3>() == Vec3(1, 1, 1));
    CHECK(!constraints.contacts().empty());
  }
}

TEST_CASE("a cloth laid over a light ball falls with it, freely", "[reacting]") {
  Cloth cloth;
  cloth.constraints.add(ball(0.01, 0.08, {0, -0.0835, 0}));
  ImplicitEuler stepper(cloth.system, cloth.constraints, make_linear_solver("mpcg"));
  for (int n = 0; n < 50; ++n) REQUIRE(stepper.advance(cloth.state, h).done);
  CHECK(cloth.body().velocity()[1] == Approx(-9.81 * 0.5).epsilon(1e-3));
  for (int i = 0; i < cloth.state.particles(); ++i)
    CHECK(cloth.state.v[3 * i + 1] == Approx(-9.81 * 0.5).epsilon(1e-3));
}

TEST_CASE("friction spins a ball up, and takes as much from the cloth", "[reacting]") {
  // A cloth drawn over a ball that is held up by it from below: a sheet pinned at its corners whose pins move
  // sideways under a ball that lies on it.
  Cloth cloth;
  Obstacle resting = ball(0.05, 0.08, {0, 0.0835, 0}, 0.8);
  cloth.constraints.add(resting);
  const Motion draw = Motion::constant({0.3, 0, 0}, Vec3::Zero(), Vec3::Zero(), 0.5, 0.8);
  cloth.constraints.pin_along({0, 12, 156, 168}, draw, cloth.state.x);
  ImplicitEuler stepper(cloth.system, cloth.constraints, make_linear_solver("mpcg"));
  for (int n = 0; n < 65; ++n) REQUIRE(stepper.advance(cloth.state, h).done);
  CHECK(cloth.body().spin()[2] > 0.3);  // the cloth draws its underside along +x
}

TEST_CASE("bodies that cannot be are refused", "[reacting]") {
  Constraints constraints;
  Obstacle o = ball(0.1, 0.1, Vec3::Zero());
  o.rigid->mass = 0;
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("mass") && Catch::Contains("positive"));
  o.rigid->mass = 1e-300;  // whose reciprocal is out of range
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("mass") && Catch::Contains("microgram"));
  o.rigid->mass = 1;
  o.rigid->inertia = Vec3(1, 1, 3).asDiagonal();
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("moment"));
  o.rigid->inertia = Mat3::Identity();
  o.rigid->inertia(0, 1) = 0.1;
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("symmetric"));
  o.rigid->inertia = Mat3::Identity();
  o.rigid->spin[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("spin"));
  o.rigid->spin = Vec3::Zero();
  o.motion = Motion::constant({1, 0, 0}, Vec3::Zero(), Vec3::Zero(), 0, 1);
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("a mass and a motion"));
  o.motion = Motion();
  o.shape = Plane{};
  CHECK_THROWS_WITH(constraints.add(o), Catch::Contains("cannot react"));
}
