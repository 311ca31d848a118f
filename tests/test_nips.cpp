// Cloth between two bodies that press on each other: rest, friction of both sides, momentum, the same bits.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>

#include "constraints/contact_step.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"
#include "tests/shapes.h"
#include "tests/sheets.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81, margin = 1e-3;

Mat3 about_z(double a) { return Eigen::AngleAxisd(a, Vec3::UnitZ()).toRotationMatrix(); }

// A sheet of 50 g, 50 cm x 50 cm, that lies on y = margin, turned with everything else by `tilt` [rad] about
// the z axis.
struct Desk {
  double tilt;
  TriangleMesh mesh;
  System system{masses(mesh, fabric())};
  Constraints constraints;
  State state = at_rest(mesh);

  explicit Desk(int n = 13, Kind kind = Kind::squares, double angle = 0)
      : tilt(angle), mesh(bent(n, kind, 0.5, [](double, double) { return margin; })) {
    for (int i = 0; i < state.particles(); ++i)
      state.x.segment<3>(3 * i) = about_z(tilt) * mesh.positions[static_cast<std::size_t>(i)];
    system.add(noh_jung(mesh, fabric()));
    system.add(Gravity{});
  }
  static Fabric fabric() { return {.area_density = 0.2, .stretch = 20000, .bend = 1e-5, .damping = 0.1}; }
  void add_table(double mu) {
    constraints.add(
        {.shape = Plane{.normal = about_z(tilt) * Vec3::UnitY()}, .friction = mu, .margin = margin});
  }
  // A body that lies with its flat side on the sheet.
  void lay(const Shape& shape, double mass, double mu, double height) {
    const UniformSolid solid = uniform_solid(shape, mass).value();
    constraints.add(
        {.shape = shape,
         .friction = mu,
         .margin = margin,
         .motion = Motion::keyframes({{.time = 0,
                                       .translate = about_z(tilt) * Vec3(0, height + 2 * margin, 0),
                                       .rotation = {0, 0, tilt}}},
                                     Vec3::Zero()),
         .rigid = RigidBody{.mass = mass, .inertia = solid.inertia, .centre = solid.centre}});
  }
  const ReactingBody& body() const {
    for (const MovingBody& moving : constraints.bodies())
      if (moving.reacting()) return *moving.reacting();
    throw InputError("no body has a mass");
  }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) p += system.masses()[i] * state.v.segment<3>(3 * i);
    for (const MovingBody& moving : constraints.bodies())
      if (moving.reacting()) p += moving.reacting()->momentum();
    return p;
  }
};

struct Named {
  const char* name;
  Shape shape;
  double flat;  // m, from its middle down to where it lies
};
std::vector<Named> lying() {
  const Vec3 size(0.2, 0.1, 0.16);
  return {{"box", Box{.centre = Vec3::Zero(), .size = size}, 0.05},
          {"plate", Plate{.centre = Vec3::Zero(), .radius = 0.1, .height = 0.04, .rim = 0.01}, 0.02},
          {"mesh", body(box_mesh(size)), 0.05}};
}
Named ball() { return {"ball", Sphere{Vec3::Zero(), 0.08}, 0.08}; }

}  // namespace

TEST_CASE("a body on cloth on a table comes to rest where both margins are left, in few solves", "[nips]") {
  std::vector<Named> bodies = lying();
  bodies.push_back(ball());
  for (const char* name : {"implicit-euler", "bdf2", "newton-kinsol", "pbd"})
    for (Kind kind : kinds)
      for (int n : {9, 13, 19})
        for (const Named& lies : bodies) {
          if (lies.flat == 0.08 && kind != Kind::squares) continue;  // a ball needs a vertex below it
          INFO(lies.name << " by " << name << ", kind " << static_cast<int>(kind) << ", n = " << n);
          Desk desk(n, kind);
          desk.add_table(0.5);
          desk.lay(lies.shape, 1, 0.4, lies.flat + 1e-3);
          const auto stepper = make_integrator(name, desk.system, desk.constraints,
                                               make_linear_solver("mpcg"), {.tolerance = 1e-6});
          int solves = 0;
          StepReport report;
          for (int k = 0; k < 60; ++k) {
            report = stepper->advance(desk.state, 0.01);
            REQUIRE(report.done);
            if (k >= 40) solves += report.linear_solves;
          }
          CHECK(desk.body().velocity().norm() < 1e-5);
          CHECK(desk.body().centre()[1] == Approx(lies.flat + 2 * margin).margin(2e-5));
          const double last = 0.01 / std::max(report.inner_steps, 1);  // s, the step of which the body tells
          CHECK(desk.body().impulse_of_bodies()[1] == Approx(g * last).epsilon(0.02));
          CHECK(solves <= 20 * 4);
        }
}

TEST_CASE("on cloth on an incline a body sticks and slides by the smoother of the two sides", "[nips]") {
  for (const auto& [mu_table, mu_body] :
       std::vector<std::pair<double, double>>{{0.5, 0.3}, {0.3, 0.5}, {0.3, 0.3}})
    for (double degrees : {10.0, 15.0, 19.0, 24.0})
      for (Kind kind : kinds) {
        const double a = degrees * std::numbers::pi / 180;
        const Named lies = lying()[static_cast<std::size_t>(kind)];
        INFO(lies.name << " at " << degrees << " degrees, table " << mu_table << ", body " << mu_body);
        Desk desk(13, kind, a);
        desk.add_table(mu_table);
        desk.lay(lies.shape, 1, mu_body, lies.flat);
        const Vec3 start = desk.body().centre();
        ImplicitEuler stepper(desk.system, desk.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-6});
        const double T = 0.25, h = 0.005;
        for (int k = 0; k < std::lround(T / h); ++k) REQUIRE(stepper.advance(desk.state, h).done);
        const double pull = g * (std::sin(a) - 0.3 * std::cos(a));
        if (pull < 0)
          CHECK((desk.body().centre() - start).norm() < 5e-4);
        else
          CHECK(desk.body().velocity().norm() == Approx(T * pull).margin(0.03 * T * 0.3 * g));
      }
}

TEST_CASE("a cloth that is pulled from under a body drags it by the friction of the body alone", "[nips]") {
  for (double mu_table : {0.1, 0.3, 0.5})
    for (double mu_body : {0.2, 0.4})
      for (Kind kind : kinds) {
        INFO("table " << mu_table << ", body " << mu_body << ", kind " << static_cast<int>(kind));
        Desk desk(13, kind);
        desk.add_table(mu_table);
        const Named lies = lying()[0];
        desk.lay(lies.shape, 1, mu_body, lies.flat);
        // All of the sheet is led, so that nothing of it stays behind: one edge, and what is beside it.
        std::vector<int> edge;
        for (int i = 0; i < desk.state.particles(); ++i)
          if (desk.state.x[3 * i] > 0.2) edge.push_back(i);
        const double acceleration = 20;  // m/s^2, which no friction gives the body
        std::vector<Keyframe> keys;
        for (double t = 0; t < 0.1501; t += 0.01)
          keys.push_back(
              {.time = t, .translate = {0.5 * acceleration * t * t, 0, 0}, .rotation = Vec3::Zero()});
        desk.constraints.pin_along(edge, Motion::keyframes(keys, Vec3::Zero()), desk.state.x);
        ImplicitEuler stepper(desk.system, desk.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-6});
        const double T = 0.12, h = 0.002;
        for (int k = 0; k < std::lround(T / h); ++k) REQUIRE(stepper.advance(desk.state, h).done);
        CHECK(desk.body().velocity()[0] == Approx(mu_body * g * T).epsilon(0.1));
      }
}

TEST_CASE("cloth that is drawn from under a body that a wall holds is rubbed by both sides", "[nips]") {
  for (const auto& [mu_table, mu_body] :
       std::vector<std::pair<double, double>>{{0.2, 0.3}, {0.2, 0.21}, {0.3, 0.2}, {0.1, 0.3}})
    for (const double speed : {0.05, 0.5})  // m/s
      for (const Kind kind : kinds) {
        INFO("table " << mu_table << ", body " << mu_body << ", " << speed << " m/s, kind "
                      << static_cast<int>(kind));
        constexpr double mass = 0.5;
        Desk desk(kind == Kind::squares ? 9 : kind == Kind::equilateral ? 13 : 19, kind);
        desk.add_table(mu_table);
        desk.lay(lying()[0].shape, mass, mu_body, lying()[0].flat);
        desk.constraints.add({.shape = Box{.centre = {0.1502, 0.1, 0}, .size = {0.1, 0.1, 0.3}},
                              .friction = 0,
                              .margin = margin});
        std::vector<int> edge;
        double dragged = 0;  // kg, of the sheet
        for (int i = 0; i < desk.state.particles(); ++i)
          if (desk.state.x[3 * i] > 0.22)
            edge.push_back(i);
          else
            dragged += desk.system.masses()[i];
        desk.constraints.pin_along(edge, Motion::constant({speed, 0, 0}, Vec3::Zero(), Vec3::Zero()),
                                   desk.state.x);
        ImplicitEuler stepper(desk.system, desk.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-6});
        double pull = 0;  // N, the mean of the last steps
        constexpr int steps = 30, last = 10;
        for (int k = 0; k < steps; ++k) {
          REQUIRE(stepper.advance(desk.state, 0.005).done);
          if (k < steps - last) continue;
          const VecX force = desk.system.force(desk.state.x, desk.state.v);
          for (int i : edge) pull -= force[3 * i] / last;
        }
        const double load = g * mass;
        CHECK(pull == Approx((mu_table + mu_body) * load + mu_table * g * dragged).epsilon(0.05));
      }
}

TEST_CASE("momentum is kept where two bodies that collide pinch cloth between them", "[nips]") {
  for (const Method& method : methods())
    for (double speed : {0.0, 3.0}) {  // m/s, at which the cloth runs through between them
      if (traits_of(method.name).grows_undamped) continue;
      // Those that do not foresee contact stop cloth that comes so fast outside of the equations.
      if (speed > 0 && !traits_of(method.name).foresees) continue;
      INFO(method.label << ", cloth at " << speed << " m/s");
      Desk desk;
      for (int i = 0; i < desk.state.particles(); ++i) desk.state.v[3 * i] = speed;
      desk.system = System{masses(desk.mesh, Desk::fabric())};
      desk.system.add(noh_jung(desk.mesh, Desk::fabric()));
      for (double side : {-1.0, 1.0}) {
        const Vec3 centre(0.02, margin + side * (0.05 + 2 * margin), 0.01);
        const double mass = 0.3 + 0.1 * side;
        desk.constraints.add({.shape = Sphere{centre, 0.05},
                              .friction = 0.4,
                              .margin = margin,
                              .rigid = RigidBody{.mass = mass,
                                                 .inertia = 0.4 * mass * 0.0025 * Mat3::Identity(),
                                                 .centre = centre,
                                                 .velocity = {0, -side, 0.3},
                                                 .gravity = Vec3::Zero()}});
      }
      const auto stepper = make_integrator(method.name, desk.system, desk.constraints,
                                           make_linear_solver("mpcg"), method.options({.tolerance = 1e-8}));
      const Vec3 before = desk.momentum();
      const double h = is_explicit(method.name) ? 1e-4 : 1e-3;
      double pressed = 0;
      for (int n = 0; n < static_cast<int>(std::lround(0.02 / h)); ++n) {
        REQUIRE(stepper->advance(desk.state, h).done);
        pressed += desk.body().impulse_of_bodies().norm();
      }
      CHECK(pressed > 0.004);  // N s, by pbd that of the last substeps: they have met through the cloth
      CHECK((desk.momentum() - before).norm() < traits_of(method.name).momentum_kept_to * before.norm());
    }
}

TEST_CASE("momentum is kept where cloth runs through between two bodies that are pressed together",
          "[nips]") {
  for (const char* name : {"implicit-euler", "newton-kinsol"})
    for (Kind kind : kinds) {
      INFO(name << ", kind " << static_cast<int>(kind));
      Desk desk(13, kind);
      desk.system = System{masses(desk.mesh, Desk::fabric())};
      desk.system.add(noh_jung(desk.mesh, Desk::fabric()));
      for (int i = 0; i < desk.state.particles(); ++i) desk.state.v[3 * i] = 3;
      for (double side : {-1.0, 1.0}) {
        const Vec3 centre(0, margin + side * (0.05 + margin), 0);
        const Box box{.centre = centre, .size = {0.2, 0.1, 0.16}};
        const UniformSolid solid = uniform_solid(box, 0.4).value();
        desk.constraints.add({.shape = box,
                              .friction = 0.3 + 0.1 * side,
                              .margin = margin,
                              .rigid = RigidBody{.mass = 0.4,
                                                 .inertia = solid.inertia,
                                                 .centre = solid.centre,
                                                 .gravity = {0, -50 * side, 0}}});
      }
      const auto stepper = make_integrator(name, desk.system, desk.constraints, make_linear_solver("mpcg"),
                                           {.tolerance = 1e-10});
      const Vec3 before = desk.momentum();
      for (int n = 0; n < 20; ++n) REQUIRE(stepper->advance(desk.state, 1e-3).done);
      CHECK(desk.body().velocity()[0] > 0.05);  // the cloth drags them along
      CHECK((desk.momentum() - before).norm() < 1e-6 * before.norm());
    }
}

TEST_CASE("a body on cloth on a table has the same bits on any number of threads", "[nips]") {
  check_same_bits([] {
    Desk desk(64);  // so many vertices that threads share them
    desk.add_table(0.5);
    desk.lay(ball().shape, 1, 0.4, 0.1);
    ImplicitEuler stepper(desk.system, desk.constraints, make_linear_solver("mpcg"));
    for (int n = 0; n < 40; ++n) REQUIRE(stepper.advance(desk.state, 0.01).done);
    return desk.state;
  });
}
