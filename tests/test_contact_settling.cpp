// Contacts settle within a step: what the bodies do to the cloth is then found from the forces alone, and
// obeys Signorini's and Coulomb's laws; and every step says how far it is from that.
#include "solver/forces/woven.h"
#include "solver/integrators/merit.h"
#include "tests/integrators.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

namespace {

// A sheet that falls on bodies: round, into a corner of two planes, into one of three, which is more than
// lock it.
struct Landing {
  std::string name;
  std::vector<Shape> bodies;
};

std::vector<Landing> landings() {
  const Plane floor, left{Vec3(-0.02, 0, 0), Vec3(1, 1, 0).normalized()},
      back{Vec3(0, 0, -0.02), Vec3(0, 1, 1).normalized()};
  return {{"ball", {Sphere{Vec3(0, -0.12, 0), 0.1}}},
          {"corner", {floor, left}},
          {"corner of three planes", {floor, left, back}}};
}

struct FallingCloth {
  TriangleMesh mesh = grid(11, 11, 0.3, 0.3);
  System system;
  Constraints constraints;
  State state;

  FallingCloth(const Landing& landing, double friction, bool as_woven = false)
      : system(lumped_mass(mesh, 0.2)), state(at_rest(mesh)) {
    const Fabric fabric{.area_density = 0.2, .stretch = 200, .bend = 1e-5, .damping = 0.01};
    system.add(as_woven ? woven(mesh, mesh, fabric) : noh_jung(mesh, fabric));
    system.add(Gravity{});
    for (const Shape& shape : landing.bodies)
      constraints.add(Obstacle{.shape = shape, .friction = friction, .margin = 0.001});
    for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] = 0.01;
  }

  double weight_impulse(double h) const {
    double squares = 0;
    for (double m : system.masses()) squares += m * m;
    return h * system.gravity_acceleration().norm() * std::sqrt(squares);
  }
};

}  // namespace

TEST_CASE("settled contacts obey Signorini's and Coulomb's laws, whatever the linear solver", "[contact]") {
  constexpr double h = 0.01;
  constexpr int most_newton = 30;
  for (const Landing& landing : landings())
    for (double friction : {0.0, 0.3})
      for (const LinearSolverInfo& solver : linear_solvers()) {
        if (solver.name != "mpcg+block-ic0" && landing.bodies.size() > 1) continue;
        INFO(landing.name << ", friction " << friction << ", " << solver.name);
        FallingCloth cloth(landing, friction, true);
        const auto stepper = make_integrator("implicit-euler", cloth.system, cloth.constraints,
                                             make_linear_solver(solver.name),
                                             {.newton_iterations = most_newton,
                                              .newton_tolerance = 1e-10,
                                              .tolerance = 1e-11,
                                              .contact_tolerance = 1e-8,
                                              .max_contact_solves = 60});
        int exact = 0;
        const double tiny = 1e-6 * cloth.weight_impulse(h);
        for (int n = 0; n < 25; ++n) {
          const State before = cloth.state;
          const StepReport report = stepper->advance(cloth.state, h);
          REQUIRE(report.done);
          if (!report.converged || report.guarded > 0 || report.substeps > 1) continue;
          if (report.newton_iterations == most_newton)
            continue;  // Newton's iteration has left something over
          VecX f = VecX::Zero(before.x.size());
          for (const auto& force : cloth.system.forces()) force->add_force(cloth.state.x, cloth.state.v, f);
          std::vector<const Contact*> touches(static_cast<std::size_t>(before.particles()), nullptr);
          for (const Contact& c : cloth.constraints.contacts()) touches[c.particle] = &c;
          double free = 0, pulled = 0, rubbed = 0;  // what should be nothing [N s]
          for (int i = 0; i < before.particles(); ++i) {
            const double m = cloth.system.masses()[i];
            const Vec3 r = m * (cloth.state.v - before.v).segment<3>(3 * i) - h * f.segment<3>(3 * i) -
                           h * m * cloth.system.gravity_acceleration();
            if (!touches[i]) {
              free = std::max(free, r.norm());
              continue;
            }
            const Contact& c = *touches[i];
            const std::array<double, 3> normal = multipliers(c, r);
            double sum = 0;
            for (int k = 0; k < c.planes; ++k) {
              pulled = std::max(pulled, -normal[k]);
              sum += std::max(normal[k], 0.0);
            }
            std::array<double, 3> along = {};
            for (int k = 0; k < c.planes; ++k) along[k] = c.plane[k].normal.dot(r);
            rubbed = std::max(rubbed, (r - along_planes(c, along)).norm() - friction * sum);
          }
          INFO("step " << n);
          CHECK(pulled <= tiny + 10 * free);  // what Newton's iteration has left over stands in all of them
          CHECK(rubbed <= tiny + 10 * free);
          exact += free <= tiny;
        }
        CHECK(exact >= 10);
      }
}

TEST_CASE("contacts settle within the tolerance in nearly every step, in few solves", "[contact]") {
  for (const std::string& name : integrator_names()) {
    if (!traits_of(name).foresees) continue;
    for (const Landing& landing : landings())
      for (bool as_woven : {false, true}) {
        INFO(name << ", " << landing.name << ", " << (as_woven ? "woven" : "noh-jung"));
        FallingCloth cloth(landing, 0.3, as_woven);
        const StepOptions options{.tolerance = 1e-4};
        const auto stepper = make_integrator(name, cloth.system, cloth.constraints,
                                             make_linear_solver("mpcg+block-ic0"), options);
        int unsettled = 0, solves = 0, newton = 0;
        constexpr int steps = 60;
        for (int n = 0; n < steps; ++n) {
          const StepReport report = stepper->advance(cloth.state, 0.01);
          REQUIRE(report.done);
          CHECK(report.converged == (report.residual <= 1.01e-4 && settled(report, options)));
          solves += report.linear_solves;
          newton += report.newton_iterations;
        }
        CHECK(unsettled <= (name == "implicit-euler" ? 0 : 2));
        if (name != "newton-kinsol") CHECK(solves <= 8 * newton);
      }
  }
}

TEST_CASE("a step whose contacts do not settle is taken in two pieces or four, and says what is left",
          "[contact]") {
  for (const std::string name : {"implicit-euler", "bdf2"})
    for (const Landing& landing : landings()) {
      INFO(name << ", " << landing.name);
      int cut = 0;
      for (const int most : {1, 30}) {
        FallingCloth cloth(landing, 0.3);
        const StepOptions options{.tolerance = 1e-4, .max_contact_solves = most};
        const auto stepper =
            make_integrator(name, cloth.system, cloth.constraints, make_linear_solver("auto"), options);
        int pieces = 0, whole = 0;
        for (int n = 0; n < 60; ++n) {
          const double start = cloth.state.time;
          const StepReport report = stepper->advance(cloth.state, 0.01);
          REQUIRE(report.done);
          CHECK(cloth.state.time == start + 0.01);
          CHECK(
              (report.substeps == 1 || report.substeps == 2 || report.substeps == 3 || report.substeps == 4));
          CHECK(report.converged == settled(report, options));
          if (!settled(report, options)) CHECK(report.substeps >= 3);
          pieces += report.substeps > 1;
          whole += report.substeps == 1;
        }
        if (most == 1) cut = pieces;
        if (most == 30) {
          CHECK(pieces < cut);
          CHECK(whole > 0);
        }
      }
      CHECK(cut > 5);
    }
}

TEST_CASE("in the energy of a step friction takes mu N times the slip, whatever it was linearised at",
          "[contact]") {
  System system(std::vector<double>{0.01});
  Merit merit(system);
  merit.begin(0.01);
  const StepCoefficients k{.h = 0.01,
                           .c = 0.01,
                           .scale = {1},
                           .fall = {0.01},
                           .mass = {0.01},
                           .x_bar = VecX::Zero(3),
                           .v_bar = VecX::Zero(3)};
  const Vec3 along_x = Vec3::UnitX(), body_velocity(0, 0.2, 0.1);
  for (const double linearised_at : {1e-6, 1e-2, 10.0}) {  // m/s
    const double most = 2e-3;                              // N s
    const Mat3 along = Vec3(1, 0, 1).asDiagonal();
    const Mat3 damping = most / linearised_at / k.h * (along - along_x * along_x.transpose());
    const ContactFriction friction{0, 0, damping, body_velocity, -most * along_x, along, most};
    for (const Vec3& slip : {Vec3(1e-5, 0, 0), Vec3(0.3, 0, 0.4), Vec3(-30, 0, 40)}) {
      const VecX v = slip + body_velocity;
      CHECK(merit.potential(k, {friction}, v) - merit.potential(k, {}, v) ==
            Approx(most * slip.norm()).epsilon(1e-6));
    }
  }
}
