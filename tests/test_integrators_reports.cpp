// What every integrator tells: the sums of its solves, failures, steps in pieces; and that it goes on from
// the state it is given, whatever it did before.
#include <functional>

#include "solver/forces/tension_spring.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

// A direct solver that counts, and fails when it is told to.
struct Counted {
  int calls = 0, iterations = 0;
  double worst = 0;
  std::function<bool()> fails = [] { return false; };
};

class Counting final : public LinearSolver {
 public:
  Counting(std::string_view name, Counted& counted) : inner_(make_linear_solver(name)), counted_(counted) {}
  std::string_view name() const override { return "counting"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report = inner_->solve(A, b, filter, options, dv);
    ++counted_.calls;
    counted_.iterations += report.iterations;
    counted_.worst = std::max(counted_.worst, report.residual);
    if (counted_.fails()) report.reason = StopReason::indefinite;
    return report;
  }

 private:
  std::unique_ptr<LinearSolver> inner_;
  Counted& counted_;
};

std::vector<std::string> implicit_names() {
  std::vector<std::string> names = integrator_names();
  std::erase_if(names, [](const std::string& n) {
    return is_explicit(n) || n == "cvode-adams" || n == "arkode-erk" || n == "pbd";
  });
  return names;
}

double apart(const State& a, const State& b) {
  return std::max((a.x - b.x).cwiseAbs().maxCoeff(), (a.v - b.v).cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("a report sums up the linear solves of its step", "[integrators]") {
  for (const std::string& name : implicit_names()) {
    INFO(name);
    HungSheet sheet(8, 300, 1e-6);
    Counted counted;
    auto stepper =
        make_integrator(name, sheet.system, sheet.constraints, std::make_unique<Counting>("mpcg", counted));
    double most = 0;
    for (int n = 0; n < 4; ++n) {
      counted.calls = counted.iterations = 0;
      counted.worst = 0;
      const StepReport report = stepper->advance(sheet.state, 0.01);
      REQUIRE(report.done);
      CHECK(counted.calls > 0);
      CHECK(report.linear_solves == counted.calls);
      CHECK(report.linear_iterations == counted.iterations);
      CHECK(report.newton_iterations > 0);
      most = std::max(most, report.residual);
      CHECK(report.residual <= (name == "newton-kinsol" ? 1e-6 : counted.worst));
    }
    CHECK(most > 0);
  }
}

TEST_CASE("every report tells how long the step took, and its parts took no longer", "[integrators]") {
  for (const Method& method : methods()) {
    INFO(method.label);
    HungSheet sheet(8, 300, 1e-6);
    auto stepper = make_integrator(method.name, sheet.system, sheet.constraints, make_linear_solver("mpcg"),
                                   method.options());
    for (int n = 0; n < 3; ++n) {
      const StepReport report = stepper->advance(sheet.state, 1e-3);
      REQUIRE(report.done);
      CHECK(report.step_ms > 0);
      CHECK(report.assemble_ms > 0);
      CHECK(report.step_ms >= report.assemble_ms + report.solve_ms + report.collide_ms);
    }
    sheet.state.v.setConstant(1e300);  // a step that fails took its time, too
    StepReport failed;
    for (int n = 0; failed.done && n < 3; ++n) failed = stepper->advance(sheet.state, 1e-3);
    CHECK_FALSE(failed.done);
    CHECK(failed.step_ms > 0);
  }
}

TEST_CASE("a step whose linear solves fail is not done, and the state stays", "[integrators]") {
  for (const std::string& name : implicit_names()) {
    INFO(name);
    HungSheet sheet(5, 300, 1e-6);
    sheet.state.v.setConstant(0.1);
    Counted counted;
    counted.fails = [] { return true; };
    StepOptions options;  // with inner steps so short that they need no solve, the end is not reached
    options.relative_tolerance = 1e-8;
    options.absolute_tolerance_position = options.absolute_tolerance_velocity = 1e-8;
    options.max_inner_steps = 500;
    auto stepper = make_integrator(name, sheet.system, sheet.constraints,
                                   std::make_unique<Counting>("eigen-ldlt", counted), options);
    const State before = sheet.state;
    const StepReport report = stepper->advance(sheet.state, 0.01);
    CHECK_FALSE(report.done);
    CHECK_FALSE(report.failure.what.empty());
    CHECK(sheet.state.x == before.x);
    CHECK(sheet.state.v == before.v);
    CHECK(sheet.state.time == before.time);
  }
}

TEST_CASE("a step that fails whole is the same as its two halves, or is given up whole", "[integrators]") {
  for (const std::string name : {"implicit-euler", "newton-kinsol"}) {
    const std::vector<std::string> all = integrator_names();
    if (std::find(all.begin(), all.end(), name) == all.end()) continue;
    INFO(name);
    HungSheet sheet(5, 300, 1e-6), halves(5, 300, 1e-6);
    Counted counted, sound;
    // Whatever is tried at first fails, until the step is halved.
    int failing = name == "newton-kinsol" ? 3 : 1;
    counted.fails = [&] { return failing-- > 0; };
    auto stepper = make_integrator(name, sheet.system, sheet.constraints,
                                   std::make_unique<Counting>("eigen-ldlt", counted), precise());
    const StepReport report = stepper->advance(sheet.state, 0.01);
    CHECK(report.done);
    CHECK(report.substeps == 2);
    CHECK(report.failure.what.empty());
    CHECK(sheet.state.time == 0.01);
    auto plain = make_integrator(name, halves.system, halves.constraints,
                                 std::make_unique<Counting>("eigen-ldlt", sound), precise());
    for (int n = 0; n < 2; ++n) REQUIRE(plain->advance(halves.state, 0.005).done);
    CHECK(apart(sheet.state, halves.state) < 1e-9);

    // The first half works, the rest does not.
    const State before = sheet.state;
    failing = name == "newton-kinsol" ? 3 : 1;
    counted.fails = [&] { return failing-- > 0 || sheet.state.time > before.time; };
    const StepReport given_up = stepper->advance(sheet.state, 0.01);
    CHECK_FALSE(given_up.done);
    CHECK(apart(sheet.state, before) == 0);
    CHECK(sheet.state.time == before.time);
  }
}

TEST_CASE("free fall is foreseen: KINSOL has nothing to solve", "[integrators]") {
  const std::vector<std::string> all = integrator_names();
  if (std::find(all.begin(), all.end(), "newton-kinsol") == all.end()) return;
  Sheet sheet(grid(4, 4, 1, 1));
  auto stepper =
      make_integrator("newton-kinsol", sheet.system, sheet.constraints, make_linear_solver("mpcg"));
  for (int n = 0; n < 5; ++n) CHECK(stepper->advance(sheet.state, 0.01).linear_solves == 0);
}

TEST_CASE("a step goes on from the state it is given, and with the pins there are", "[integrators]") {
  for (const std::string& name : integrator_names()) {
    const bool inner = order_of(name) == 0;
    const double h = is_explicit(name) ? 1e-3 : 0.005;
    StepOptions options = precise();
    options.relative_tolerance = 1e-8;
    options.absolute_tolerance_position = options.absolute_tolerance_velocity = 1e-8;
    for (const bool pinned : {false, true}) {
      INFO(name << (pinned ? ", another pin" : ", moved"));
      Course used = drum(), fresh = drum();
      const auto make = [&](Course& m) {
        return make_integrator(name, m.system, m.constraints, make_linear_solver("eigen-ldlt"), options);
      };
      auto stepper = make(used);
      State state = used.start;
      for (int n = 0; n < 3; ++n) REQUIRE(stepper->advance(state, h).done);
      if (pinned) {
        used.constraints.pin(12);
        fresh.constraints.pin(12);
        state.v.segment<3>(36).setZero();
      } else {
        for (int i = 6; i < 9; ++i) state.x[3 * i + 1] += 0.02;
      }
      State other = state;
      auto anew = make(fresh);
      const StepReport report = stepper->advance(state, h);
      REQUIRE(report.done);
      REQUIRE(anew->advance(other, h).done);
      if (name == "bdf2") continue;  // its past is of the second order, a new one's of the first
      CHECK(apart(state, other) < (inner ? 1e-5 : 1e-12));
      if (inner) CHECK(report.inner_steps > 0);
    }
  }
}

TEST_CASE("inner steps are those of one step, and a tolerance is of its own quantity", "[integrators]") {
  for (const std::string& name : integrator_names()) {
    if (order_of(name) != 0) continue;
    INFO(name);
    // A mass of 1000 rad/s: an error of its velocity is a thousand times that of its position.
    const auto inner_steps = [&](double position, double velocity) {
      System system({0.0, 1.0});
      system.add(std::make_unique<PairForce<TensionSpring>>(
          std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1, 1e6}}}));
      system.add(Gravity{{1e5, 0, 0}});
      Constraints constraints;
      State state{0, VecX::Zero(6), VecX::Zero(6)};
      state.x[3] = 1.15;  // swings by 0.05 around 1.1, never slack
      StepOptions options = precise();
      options.relative_tolerance = 1e-13;
      options.absolute_tolerance_position = position;
      options.absolute_tolerance_velocity = velocity;
      auto stepper = make_integrator(name, system, constraints, make_linear_solver("eigen-ldlt"), options);
      std::vector<int> steps;
      for (int n = 0; n < 12; ++n) {
        const StepReport report = stepper->advance(state, 0.005);
        REQUIRE(report.done);
        steps.push_back(report.inner_steps);
      }
      CHECK(steps.back() > 0);
      CHECK(steps.back() < 3 * steps[3]);  // as many in every step, not all since the start
      return steps.back();
    };
    CHECK(inner_steps(1e-6, 1e9) < 0.7 * inner_steps(1e9, 1e-6));
  }
}
