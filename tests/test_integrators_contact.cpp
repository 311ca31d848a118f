// Constraints hold on cloth in every integrator of the build: pins and contact, to first order in the time
// step; and the same bits everywhere. test_integrators_particle.cpp has what they do to single particles.
#include "app/simulation/simulation.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"

#include "tests/places.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

// A soft, damped sheet over a body, that every integrator can step.
struct Drop {
  TriangleMesh mesh = grid(11, 11, 0.3, 0.3);
  System system;
  Constraints constraints;
  State state;

  explicit Drop(Shape shape, double friction = 0.3) : system(lumped_mass(mesh, 0.3)), state(at_rest(mesh)) {
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
    system.add(Gravity{});
    constraints.add(Obstacle{.shape = std::move(shape), .friction = friction});
    for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] = 0.02;
  }
};

// Explicit Euler needs h below what the damping over the stiffness allows.
double step_for(std::string_view name) { return is_explicit(name) ? 4e-4 : 0.01; }

int steps_for(std::string_view name, double duration) {
  return static_cast<int>(std::lround(duration / step_for(name)));
}

}  // namespace

TEST_CASE("pinned and massless particles stay, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    const TriangleMesh mesh = grid(6, 6, 0.3, 0.3);
    std::vector<double> masses = lumped_mass(mesh, 0.3);
    masses[35] = 0;
    System system(masses);
    system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.pin({0, 5});
    State state = at_rest(mesh);
    state.x.array() += 0.1;  // not round
    const VecX start = state.x;
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
    for (int n = 0; n < steps_for(name, 0.3); ++n) REQUIRE(stepper->advance(state, step_for(name)).done);
    INFO(method.label);
    for (int i : {0, 5, 35}) {
      CHECK(state.x.segment<3>(3 * i) == start.segment<3>(3 * i));
      CHECK(state.v.segment<3>(3 * i).norm() == 0);
    }
    CHECK((state.x - start).cwiseAbs().maxCoeff() > 0.01);
    CHECK(state.time == Approx(0.3));
  }
}

TEST_CASE("a cloth is never inside a body and comes to rest, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const bool ball : {true, false}) {
      Drop drop = ball ? Drop(Sphere{{0, -0.1, 0}, 0.1}) : Drop(Plane{{0, 0, 0}, {0, 1, 0}});
      auto stepper =
          make_integrator(name, drop.system, drop.constraints, make_linear_solver("mpcg"), method.options());
      double deepest = 0;
      int contacts = 0;
      INFO(method.label << (ball ? " on a ball" : " on a plane"));
      for (int n = 0; n < steps_for(name, 2); ++n) {
        const StepReport report = stepper->advance(drop.state, step_for(name));
        INFO("step " << n << ": " << report.failure.what << " " << report.failure.force);
        REQUIRE(report.done);
        for (double depth : drop.constraints.penetration(drop.state.x)) deepest = std::max(deepest, depth);
        contacts = report.contacts;
      }
      CHECK(deepest < 1e-9);
      CHECK(contacts > (ball ? 5 : 100));
      CHECK(max_speed(drop.state) < (ball ? 0.03 : 0.005));
    }
  }
}

TEST_CASE("pins hold and the floor does, in one cloth, whatever the integrator", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    for (const double height : {0.01, 0.08}) {  // begins in contact within a step or two, or in flight
      const TriangleMesh mesh = grid(9, 9, 0.3, 0.3);
      System system(lumped_mass(mesh, 0.3));
      system.add(noh_jung(mesh, {.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.01}));
      system.add(Gravity{});
      Constraints constraints;
      constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, {0, 1, 0}}, .friction = 0.3});
      constraints.pin({0, 8});
      State state = at_rest(mesh);
      for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] = height + 0.1 * (state.x[3 * i] + 0.15);
      const State start = state;
      auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
      INFO(method.label << " from " << height << " m");
      double lowest = 1;
      int contacts = 0;
      for (int n = 0; n < steps_for(name, 1); ++n) {
        const StepReport report = stepper->advance(state, step_for(name));
        INFO("step " << n << ": " << report.failure.what);
        REQUIRE(report.done);
        CHECK(report.penetration < 1e-9);
        contacts = std::max(contacts, report.contacts);
        for (int i = 0; i < state.particles(); ++i) lowest = std::min(lowest, state.x[3 * i + 1]);
      }
      CHECK(lowest > -1e-9);
      CHECK(contacts > 30);
      for (int i : {0, 8}) {
        CHECK(state.x.segment<3>(3 * i) == start.x.segment<3>(3 * i));
        CHECK(state.v.segment<3>(3 * i).norm() == 0);
      }
      CHECK(system.kinetic_energy(state.v) + system.elastic_energy(state.x) + system.gravity_energy(state.x) <
            system.elastic_energy(start.x) + system.gravity_energy(start.x));
    }
  }
}

TEST_CASE("newton-kinsol solves its equation on crumpled cloth", "[integrators]") {
  // A T-shirt on a body, where |F| alone has false minima in most steps.
  const auto names = integrator_names();
  if (std::find(names.begin(), names.end(), "newton-kinsol") == names.end()) return;
  Simulation tee = make_simulation(read_scene(source_dir() + "/data/scenes/tee.toml",
                                              {parse_setting("simulation.integrator=newton-kinsol")}));
  for (int n = 0; n < 10; ++n) {
    const StepReport report = tee.integrator->advance(tee.state, 0.01);
    INFO("step " << n << ": " << report.failure.what);
    REQUIRE(report.done);
    CHECK((report.converged || report.contact_residual > 0));  // the equation is solved in any case
    CHECK(report.substeps <= 4);  // contacts of faces come and go: kinks that may cut a step
    CHECK(report.residual <= 1e-6);
  }
}

TEST_CASE("stiff cloth that vibrates within a step keeps its energy at a contact", "[integrators]") {
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    if (!bears_stiff(name)) continue;
    const TriangleMesh mesh = grid(11, 11, 0.6, 0.6);
    System system(lumped_mass(mesh, 0.15));
    system.add(noh_jung(mesh, {.area_density = 0.15, .stretch = 500, .bend = 1e-5}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Sphere{{0, -0.22, 0}, 0.2}, .friction = 0.3});
    State state = at_rest(mesh);
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options());
    const double fall = 9.81 * 0.15 * 0.36 * 0.6;  // J: more than there is to gain
    for (int n = 0; n < 40; ++n) {
      REQUIRE(stepper->advance(state, 0.01).done);
      INFO(method.label << ", step " << n);
      CHECK(system.kinetic_energy(state.v) + system.elastic_energy(state.x) < fall);
    }
  }
}

TEST_CASE("contact is of first order in the time step at least, whatever the integrator", "[integrators]") {
  // A mass flies onto a plane, keeps what friction leaves of its speed, and slides on:
  //   x = v t' + (v - mu g t')(T - t') - mu g (T - t')^2 / 2,  t': when it lands
  const double mu = 0.2, g = 10, speed = 3, landing = 0.1, end = 0.3;
  const double exact = speed * landing + (speed - mu * g * landing) * (end - landing) -
                       0.5 * mu * g * (end - landing) * (end - landing);
  for (const Method& method : methods()) {
    const std::string& name = method.name;
    std::vector<double> error;
    for (const int steps :
         {30, 90, 270}) {  // it lands at the same place within a step, a third before its end
      const int before = steps / 3;
      const double h = landing / (before + 2.0 / 3);
      System system({0.1});
      system.add(Gravity{{0, -g, 0}});
      Constraints constraints;
      constraints.add(Obstacle{.shape = Plane{}, .friction = mu, .margin = 0.001});
      State state{0, VecX(Vec3(0, 0.001 + 0.5 * g * landing * landing, 0)), VecX(Vec3(speed, 0, 0))};
      StepOptions options = precise();
      options.relative_tolerance = 1e-10;
      options.absolute_tolerance_position = options.absolute_tolerance_velocity = 1e-10;
      auto stepper =
          make_integrator(name, system, constraints, make_linear_solver("mpcg"), method.options(options));
      const int whole = static_cast<int>(end / h);
      for (int n = 0; n < whole; ++n) REQUIRE(stepper->advance(state, h).done);
      if (end - whole * h > 1e-9) REQUIRE(stepper->advance(state, end - whole * h).done);
      CHECK(state.x[1] == Approx(0.001).margin(1e-9));
      error.push_back(std::abs(state.x[0] - exact));
    }
    INFO(method.label << ": " << error[0] << ", " << error[1] << ", " << error[2]);
    CHECK(error[2] > 1e-6);
    CHECK(std::log(error[1] / error[2]) / std::log(3) > 0.65);
  }
}

TEST_CASE("every integrator gives the same bits with 1, 2 and 7 threads", "[integrators]") {
  for (const Method& method : methods()) {
    INFO(method.label);
    check_same_bits([&] {
      LargeSheet sheet;
      sheet.constraints.add(Obstacle{.shape = Sphere{{0, -0.102, 0}, 0.1}});
      auto stepper = make_integrator(method.name, sheet.system, sheet.constraints, make_linear_solver("mpcg"),
                                     method.options({.tolerance = 1e-4}));
      const double h = is_explicit(method.name) ? 4e-4 : 4e-3;
      for (int n = 0; n < 4; ++n) REQUIRE(stepper->advance(sheet.state, h).done);
      return sheet.state;
    });
  }
}
