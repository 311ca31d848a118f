// Laws of one implicit step: free fall, same bits, no allocation, honest failure, Newton's convergence.
#include <catch2/catch.hpp>
#include <cstring>

#include "tests/allocations.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("free fall is exact, however loose or short the solve", "[step]") {
  for (const StepOptions& options :
       {StepOptions{}, StepOptions{.tolerance = 0.5}, StepOptions{.max_linear_iterations = 1},
        StepOptions{.newton_iterations = 4}}) {
    Sheet sheet(grid(20, 20, 1, 1), {.damping = 0.05});
    sheet.constraints.add(Obstacle{.shape = Plane{{0, -100, 0}, {0, 1, 0}}});
    auto stepper = sheet.stepper(options);
    const VecX start = sheet.state.x;
    for (int n = 1; n <= 50; ++n) {
      const StepReport report = stepper.advance(sheet.state, 0.01);
      REQUIRE(report.done);
      CHECK(report.linear_iterations == 0);
      const double fallen = 9.81 * 1e-4 * n * (n + 1) / 2;  // the scheme's own exact value
      for (int i = 0; i < sheet.state.particles(); ++i)
        CHECK((sheet.state.x.segment<3>(3 * i) - start.segment<3>(3 * i) + Vec3(0, fallen, 0)).norm() <
              1e-11);
    }
    CHECK(sheet.state.time == Approx(0.5));
  }
}

TEST_CASE("a truncated solve says so, and does not eat gravity", "[step]") {
  // Hung by two corners; three iterations a step reach a few vertices around the pins only.
  // The far edge must still fall freely.
  Sheet sheet(grid(60, 60, 1, 1), {.stretch = 1000});
  sheet.constraints.pin({0, 59});
  auto stepper = sheet.stepper({.max_linear_iterations = 3});
  const int far = 60 * 60 - 30;
  bool said = false;
  for (int n = 0; n < 10; ++n) {
    const StepReport report = stepper.advance(sheet.state, 0.01);
    REQUIRE(report.done);
    said = said || !report.converged;
    CHECK(report.residual >= 0);
  }
  CHECK(said);
  CHECK(-sheet.state.x[3 * far + 1] == Approx(9.81 * 1e-4 * 55).epsilon(0.02));
}

TEST_CASE("the same bits with 1, 2 and 7 threads, and from run to run", "[step]") {
  const ThreadsRestored restored;
  for (const int side :
       {31, 64}) {  // threads share heavy loops from 600 particles on, light ones from 2000 on
    VecX first_x, first_v;
    for (int t : {1, 2, 7, 1}) {
      set_threads(t);
      TriangleMesh mesh = grid(side, side, 1, 1);
      Sheet sheet(mesh, {.stretch = 300, .damping = 1e-3});
      sheet.constraints.pin(0);
      sheet.constraints.add(Obstacle{.shape = Sphere{{0, -0.11, 0}, 0.1}});
      sheet.constraints.add(Obstacle{.shape = MeshBody(std::make_shared<SurfaceDistance>([&] {
                                       TriangleMesh ball = sphere(2, 0.1);
                                       for (Vec3& p : ball.positions) p += Vec3(0.25, -0.12, 0.1);
                                       return ball;
                                     }()))});
      auto stepper = sheet.stepper();
      std::vector<double> unrelated(static_cast<std::size_t>(17 * t));  // another place in memory
      int contacts = 0;
      for (int n = 0; n < 15; ++n) contacts = std::max(contacts, stepper.advance(sheet.state, 0.01).contacts);
      CHECK(contacts > 10);
      if (first_x.size() == 0) {
        first_x = sheet.state.x;
        first_v = sheet.state.v;
      }
      INFO(side << " vertices a side, " << t << " threads");
      CHECK(same_bits(first_x, sheet.state.x));
      CHECK(same_bits(first_v, sheet.state.v));
    }
  }
}

TEST_CASE("a step allocates nothing after the first", "[step]") {
  if (!counts_allocations()) {
    WARN("skipped: allocations are not counted under the sanitizers");
    return;
  }
  const ThreadsRestored restored;
  struct Case {
    int threads, order;
    const char* solver;
    int side = 64;
  };
  for (const Case c : {Case{1, 1, "mpcg"}, Case{2, 1, "mpcg"}, Case{1, 2, "mpcg"}, Case{2, 2, "mpcg"},
                       Case{2, 1, "mpcg+block-ic0"}, Case{2, 1, "auto"}, Case{2, 1, "mpcg+block-ic0", 40}}) {
    set_threads(c.threads);
    TriangleMesh mesh = grid(c.side, c.side, 1, 1);
    Sheet sheet(mesh, {.damping = 1e-3});
    sheet.constraints.pin({0, c.side - 1});
    sheet.constraints.add(Obstacle{.shape = Sphere{{0, -0.15, 0}, 0.1}, .friction = 0.3});
    Bdf stepper(sheet.system, sheet.constraints, make_linear_solver(c.solver), {.tolerance = 1e-4}, c.order);
    stepper.advance(sheet.state, 0.01);
    if (c.order == 2) stepper.advance(sheet.state, 0.01);  // the first that looks back
    const long before = allocations();
    int contacts = 0;
    for (int n = 0; n < 20; ++n) contacts = std::max(contacts, stepper.advance(sheet.state, 0.01).contacts);
    const long used = allocations() - before;
    CHECK(contacts > 5);
    INFO(c.solver << ", " << c.threads << " threads, order " << c.order);
    CHECK(used == 0);
  }
}

TEST_CASE("a step that cannot be done leaves the state as it was and says where", "[step]") {
  Sheet sheet(grid(5, 5, 1, 1), {.stretch = 1e300, .bend = 0});
  sheet.constraints.pin(0);
  auto stepper = sheet.stepper({.max_halvings = 3});
  sheet.state.x[3 * 12] += 1e200;  // a distance whose square is infinite
  const State before = sheet.state;
  const StepReport report = stepper.advance(sheet.state, 0.01);
  CHECK_FALSE(report.done);
  CHECK_FALSE(report.failure.what.empty());
  CHECK(report.failure.particle >= 0);
  CHECK(report.failure.force == "stretch");
  CHECK(same_bits(before.x, sheet.state.x));
  CHECK(sheet.state.time == before.time);
}

namespace {

// Fails every solve until the time step has been halved often enough:
// told from the mass it sees on the diagonal.
class Fussy final : public LinearSolver {
 public:
  explicit Fussy(double largest_scale) : largest_(largest_scale) {}
  std::string_view name() const override { return "fussy"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report = inner_->solve(A, b, filter, options, dv);
    if (options.scale > largest_) report.reason = StopReason::iteration_limit;  // scale = h |m g|
    return report;
  }

 private:
  double largest_;
  std::unique_ptr<LinearSolver> inner_ = make_linear_solver("mpcg");
};

}  // namespace

TEST_CASE("a step that fails is taken in halves, and says how many", "[step]") {
  Sheet sheet(grid(5, 5, 1, 1));
  sheet.constraints.pin(0);
  double weight = 0;
  for (double m : sheet.system.masses()) weight += m * m;
  weight = 9.81 * std::sqrt(weight);
  ImplicitEuler stepper(sheet.system, sheet.constraints, std::make_unique<Fussy>(0.003 * weight));
  StepReport report = stepper.advance(sheet.state, 0.01);
  CHECK(report.done);
  CHECK(report.substeps == 4);
  CHECK(sheet.state.time == 0.01);
  // The same as four quarter steps.
  Sheet quarter(grid(5, 5, 1, 1));
  quarter.constraints.pin(0);
  auto plain = quarter.stepper();
  for (int k = 0; k < 4; ++k) plain.advance(quarter.state, 0.0025);
  CHECK(same_bits(quarter.state.x, sheet.state.x));

  ImplicitEuler hopeless(sheet.system, sheet.constraints, std::make_unique<Fussy>(0.0), {.max_halvings = 2});
  report = hopeless.advance(sheet.state, 0.01);
  CHECK_FALSE(report.done);
  CHECK_THAT(report.failure.what, Catch::Contains("iteration limit"));
}

TEST_CASE("more Newton iterations solve the nonlinear equation", "[step]") {
  double last = 1e9;
  for (int newton : {1, 2, 4, 8}) {
    Sheet sheet(grid(10, 10, 1, 1), {.stretch = 50});
    sheet.constraints.pin({0, 9});
    auto stepper = sheet.stepper({.newton_iterations = newton, .newton_tolerance = 1e-9, .tolerance = 1e-10});
    for (int n = 0; n < 20; ++n) stepper.advance(sheet.state, 0.01);
    const State before = sheet.state;
    stepper.advance(sheet.state, 0.01);
    // M (v - v0) - h f(x, v) at the end of the step, where nothing is pinned.
    const VecX f = sheet.system.force(sheet.state.x, sheet.state.v);
    double residual = 0;
    for (int i = 0; i < 100; ++i) {
      if (i == 0 || i == 9) continue;
      const Vec3 r =
          sheet.system.masses()[i] * (sheet.state.v.segment<3>(3 * i) - before.v.segment<3>(3 * i)) -
          0.01 * f.segment<3>(3 * i);
      residual = std::max(residual, r.norm());
    }
    INFO(newton << " iterations, residual " << residual);
    CHECK(residual < last);
    last = std::max(0.5 * residual, 1e-12);
  }
  CHECK(last < 1e-8);
}

TEST_CASE("a step makes no energy, however stiff the cloth and long the step", "[step]") {
  for (double stretch : {1e3, 1e5, 1e7}) {
    for (double bend : {1e-6, 1e-3}) {
      Sheet sheet(equilateral_sheet(5, 12, 0.01), {.area_density = 0.2, .stretch = stretch, .bend = bend});
      sheet.constraints.pin({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
      auto stepper = sheet.stepper();
      const auto energy = [&] {
        return sheet.system.elastic_energy(sheet.state.x) + sheet.system.kinetic_energy(sheet.state.v) +
               sheet.system.gravity_energy(sheet.state.x);
      };
      const double start = energy();
      for (int n = 0; n < 60; ++n) {
        const StepReport report = stepper.advance(sheet.state, 0.02);
        INFO("stretch " << stretch << ", bend " << bend << ", step " << n);
        REQUIRE(report.done);
        CHECK(report.substeps == 1);
        CHECK(energy() < start + 1e-3);
      }
    }
  }
}

TEST_CASE("bad calls are refused", "[step]") {
  Sheet sheet(grid(3, 3, 1, 1));
  auto stepper = sheet.stepper();
  CHECK_THROWS_AS(stepper.advance(sheet.state, 0), InputError);
  CHECK_THROWS_AS(stepper.advance(sheet.state, -0.01), InputError);
  CHECK_THROWS_AS(stepper.advance(sheet.state, std::nan("")), InputError);
  State wrong{0, VecX::Zero(6), VecX::Zero(6)};
  CHECK_THROWS_AS(stepper.advance(wrong, 0.01), InputError);
  CHECK_THROWS_AS(set_threads(0), InputError);
  CHECK_THROWS_WITH(make_integrator("leapfrog", sheet.system, sheet.constraints, make_linear_solver("mpcg")),
                    Catch::Contains("leapfrog") && Catch::Contains("implicit-euler"));
}
