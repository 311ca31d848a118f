// A step that fails after a part of it was done leaves everything as it was, bodies that react as well.
#include <catch2/catch.hpp>
#include <limits>
#include <memory>

#include "mesh/triangles/generate.h"
#include "solver/assembly/assembly.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

// Has no finite value in what is taken after the time `from` [s].
struct Breaking final : Force {
  const double& from;
  double now = 0;  // end of what is taken [s]
  explicit Breaking(const double& time) : from(time) {}
  double value() const { return now > from ? std::numeric_limits<double>::quiet_NaN() : 0; }
  std::string_view name() const override { return "breaking"; }
  bool changes() const override { return true; }
  bool begin_step(const StepStart& start) override {
    now = start.t + start.h;
    return false;
  }
  void list_pairs(std::vector<ParticlePair>&) const override {}
  void bind(const BlockLayout&) override {}
  double energy(const VecX&) const override { return value(); }
  void add_force(const VecX&, const VecX&, VecX& f) const override { f[0] += value(); }
  void add_linearised(const VecX&, const VecX&, const VecX&, double, Stiffness, BlockMatrix&,
                      VecX& b) const override {
    b[0] += value();
  }
  bool projects() const override { return true; }
  void project(Substep& substep) override { substep.x[0] += value(); }
};

// A sheet that falls on a ball, which falls more slowly.
struct Falling : Assembly {
  double breaks_from = 1e9;  // s
  explicit Falling(int vertices) : Assembly({0, -9.81, 0}) {
    constraints->add(
        Obstacle{.shape = Sphere{{0, 0, 0}, 0.1},
                 .margin = 1e-3,
                 .rigid = RigidBody{.mass = 0.1, .inertia = 4e-4 * Mat3::Identity(), .gravity = {0, -1, 0}}});
    ClothPart sheet{.mesh = grid(vertices, vertices, 0.3, 0.3)};
    for (Vec3& x : sheet.mesh.positions) x += Vec3(0.01, 0.103, 0.02);
    add(sheet);
  }
  void use_all(const std::string& name, const StepOptions& options) {
    use(name, "mpcg", options);
    system->add(std::make_unique<Breaking>(breaks_from));
  }
};

}  // namespace

TEST_CASE("a step that fails in its second half takes back what its first half did", "[body][pbd]") {
  for (const char* integrator : {"implicit-euler", "bdf2", "newton-kinsol", "pbd"})
    for (const int vertices : {5, 8, 13}) {
      INFO(integrator << ", " << vertices << " vertices");
      Falling all(vertices);
      StepOptions options;
      options.max_halvings = 1;
      options.projection.substeps = 2;
      all.use_all(integrator, options);
      for (int n = 0; n < 6; ++n) REQUIRE(all.advance(0.01).done);
      const ReactingBody& ball = *all.constraints->bodies()[0].reacting();
      REQUIRE(ball.impulse_of_cloth().norm() > 1e-5);
      const State start = all.state;
      const Vec3 place = ball.centre(), speed = ball.velocity(), spin = ball.spin();
      all.breaks_from = all.state.time + 0.0075;
      const StepReport report = all.advance(0.01);
      CHECK_FALSE(report.done);
      CHECK(report.failure.what != "");
      CHECK(same_bits(start.x, all.state.x));
      CHECK(same_bits(start.v, all.state.v));
      CHECK(ball.centre() == place);
      CHECK(ball.velocity() == speed);
      CHECK(ball.spin() == spin);
      all.breaks_from = 1e9;
      CHECK(all.advance(0.005).done);
      CHECK((ball.centre() - place).norm() < 0.005 * 2 * std::max(speed.norm(), 0.1));
    }
}
