// The two forms of contact without a solve: the formulas against numbers worked out by hand, cloth, the
// switch. test_response_particle.cpp has what they do to single particles.
#include "app/scene/scene.h"
#include "app/simulation/simulation.h"
#include "constraints/response.h"
#include "mesh/base/errors.h"
#include "tests/allocations.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"

#include "tests/places.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Matchers::Contains;

namespace {

const Vec3 up(0, 1, 0), still(0, 0, 0);

}  // namespace

TEST_CASE("the response of Bridson, Marino & Fedkiw 2003 as it is written, against numbers by hand",
          "[response]") {
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

TEST_CASE("the impact of the soft-cube report, against numbers by hand", "[response]") {
  CHECK((reflected({3, -4, 1}, still, up, 0.5) - Vec3(3, 2, 1)).norm() < 1e-14);
  CHECK((reflected({3, -4, 1}, still, up, 0) - Vec3(3, 0, 1)).norm() < 1e-14);
  CHECK((reflected({3, -4, 1}, still, up, 1) - Vec3(3, 4, 1)).norm() < 1e-14);
  CHECK(reflected({3, 4, 1}, still, up, 0.5) == Vec3(3, 4, 1));
  // a body that comes up with 2 m/s: v_N = -6 -> 3, and 2 with it
  CHECK((reflected({3, -4, 1}, {1, 2, 0}, up, 0.5) - Vec3(3, 5, 1)).norm() < 1e-14);
}

TEST_CASE("the step of the soft-cube report, against numbers by hand", "[response]") {
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
    fallen[rough] = -height;
    if (rough) CHECK(max_speed(state) < 0.05);
  }
  INFO("mean depth " << fallen[0] << " m without friction, " << fallen[1] << " m with");
  CHECK(fallen[0] > 1);  // on its way down
  CHECK(fallen[1] < 0.15);
}

TEST_CASE("both forms give the same bits with 1, 2 and 7 threads", "[response]") {
  for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
    INFO(name(mode));
    check_same_bits([&] {
      LargeSheet sheet;
      Obstacle ball{.shape = Sphere{{0, -0.1021, 0}, 0.1}, .restitution = 0.5};
      ball.rigid = RigidBody{.mass = 0.1, .inertia = 4e-4 * Mat3::Identity(), .gravity = Vec3::Zero()};
      sheet.constraints.add(ball);
      for (int i = 1; i < sheet.state.particles(); ++i) sheet.state.v[3 * i + 1] = -0.5;
      auto stepper = make_integrator("symplectic-euler", sheet.system, sheet.constraints,
                                     make_linear_solver("mpcg"), StepOptions{.contact = mode});
      int contacts = 0;
      for (int n = 0; n < 20; ++n) contacts += stepper->advance(sheet.state, 5e-4).contacts;
      CHECK(contacts > 0);
      return sheet.state;
    });
  }
}

TEST_CASE("each integrator has its contact mode, and says which it cannot take", "[response]") {
  for (const std::string& name : integrator_names()) {
    INFO(name);
    const bool responds = is_explicit(name) || only_responds(name);
    if (only_responds(name))
      CHECK_THROWS_WITH(contact_mode(name, ContactMode::constraint), Contains("velocity"));
    else
      CHECK(contact_mode(name, ContactMode::constraint) == ContactMode::constraint);
    CHECK(contact_mode(name, {}) == (responds ? ContactMode::velocity : ContactMode::constraint));
    for (const ContactMode mode : {ContactMode::velocity, ContactMode::restitution}) {
      if (responds) {
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
  const std::string path = source_dir() + "/data/scenes/ls-ball-09.toml";
  const auto read = [&](const std::vector<std::string>& words) {
    std::vector<Setting> settings;
    for (const std::string& word : words) settings.push_back(parse_setting(word));
    return read_scene(path, settings);
  };
  CHECK_FALSE(read_scene(source_dir() + "/data/scenes/tee.toml", {}).simulation.step.contact);
  CHECK(read({"simulation.contact=restitution"}).simulation.step.contact == ContactMode::restitution);
  CHECK(read({"obstacle.ball.restitution=0.4"}).obstacles[0].obstacle.restitution == 0.4);
  CHECK_THROWS_WITH(read({"obstacle.ball.restitution=1.4"}), Contains("from 0 to 1"));
  CHECK_THROWS_WITH(read({"simulation.contact=velocty"}), Contains("velocity"));
  CHECK_THROWS_WITH(read({"simulation.contact=velocity", "simulation.integrator=bdf2"}),
                    Contains("simulation.contact") && Contains("bdf2") && Contains("symplectic-euler"));

  const auto says = [&](const Scene& scene, const std::string& text) {
    for (const std::string& message : make_simulation(scene).messages)
      if (message.find(text) != message.npos) return true;
    return false;
  };
  const auto warned = [&](const std::vector<std::string>& words,
                          const std::string& text = "restitution has no effect") {
    return says(read(words), text);
  };
  CHECK(warned({"obstacle.ball.restitution=0.4"}));
  CHECK_FALSE(warned({"obstacle.ball.restitution=0.4", "simulation.contact=restitution"}));
  CHECK_FALSE(warned({}));
  Scene two =
      read({"obstacle.ball.restitution=0.4", "obstacle.ball.mass=0.1"});  // which spring back from each other
  two.obstacles.push_back(two.obstacles[0]);
  two.obstacles[1].name = "other";
  CHECK_FALSE(says(two, "restitution has no effect"));

  const std::vector<IntegratorInfo> known = integrators();
  if (std::none_of(known.begin(), known.end(), [](const auto& one) { return one.name == "cvode-bdf"; }))
    return;
  const std::string momentum = "cvode-bdf does not keep its momentum";
  const std::string held = "simulation.contact=constraint", by = "simulation.integrator=cvode-bdf";
  CHECK(warned({held, by, "obstacle.ball.mass=0.1"}, momentum));
  CHECK_FALSE(warned({held, by}, momentum));
  CHECK_FALSE(warned({"obstacle.ball.mass=0.1"}, momentum));
  const std::string energy = "may gain energy in steps of 10 ms";
  CHECK(warned({held, by, "simulation.time_step=0.01"}, energy));
  CHECK_FALSE(warned({held, by, "simulation.time_step=0.001"}, "may gain energy"));
  CHECK_FALSE(warned({"simulation.time_step=0.01"}, "may gain energy"));
}

TEST_CASE("a step with a response allocates nothing", "[response]") {
  if (!counts_allocations()) return;
  for (const auto& [name, mode] : {std::pair{"symplectic-euler", ContactMode::velocity},
                                   {"symplectic-euler", ContactMode::restitution},
                                   {"pbd", ContactMode::velocity},
                                   {"pbd", ContactMode::restitution}}) {
    const TriangleMesh mesh = grid(11, 11, 0.3, 0.3);
    System system(lumped_mass(mesh, 0.3));
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Sphere{{0, -0.105, 0}, 0.1}, .restitution = 0.3});
    constraints.add(Obstacle{.shape = Plane{{0, -0.01, 0}, {0, 1, 0}}, .restitution = 0.3});
    State state = at_rest(mesh);
    StepOptions options{.contact = mode};
    options.projection = {.substeps = 2, .iterations = 2};
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < 200; ++n) REQUIRE(stepper->advance(state, 4e-4).done);
    const long before = allocations();
    int contacts = 0;
    for (int n = 0; n < 50; ++n) contacts += stepper->advance(state, 4e-4).contacts;
    const long made = allocations() - before;
    CHECK(contacts > 50);
    CHECK(made == 0);
  }
}
