// Cloth that lands on a slope, lies on it or is laid on it: Coulomb's law for sheets of three kinds and
// sizes, against closed forms.
#include <catch2/catch.hpp>
#include <numbers>

#include "solver/forces/face_contact_force.h"
#include "solver/forces/woven.h"
#include "tests/integrators.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

using std::numbers::pi;

constexpr double g = 9.81, margin = 2e-3;

// A sheet of 10 cm on a slope, or above one.
struct OnSlope {
  double angle;
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  OnSlope(int n, Kind kind, double slope, const Friction& friction, bool of_springs, const Fabric& fabric)
      : angle(slope),
        mesh(bent(n, kind, 0.1, [](double, double) { return 0.0; })),
        system(lumped_mass(mesh, fabric.area_density)),
        state(at_rest(mesh)) {
    system.add(of_springs ? noh_jung(mesh, fabric) : woven(mesh, mesh, fabric));
    system.add(Gravity{});
    constraints.add(Obstacle{.shape = Plane{Vec3::Zero(), normal()}, .friction = friction, .margin = margin});
    std::vector<ClothFace> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({{t[0], t[1], t[2]}, fabric.stretch});
    constraints.add_faces(faces);
    system.add(face_contact_force(constraints));
  }
  Vec3 normal() const { return {std::sin(angle), std::cos(angle), 0}; }
  Vec3 down() const { return {std::cos(angle), -std::sin(angle), 0}; }
  void lay() { state.x = moved_rigidly(state.x, rotation(-angle, {0, 0, 1}), margin * normal()); }
  void let_go_level(double fall) {  // m, of the point that lands first
    double lowest = 1;
    for (int i = 0; i < state.particles(); ++i)
      lowest = std::min(lowest, state.x.segment<3>(3 * i).dot(normal()));
    for (int i = 0; i < state.particles(); ++i) state.x[3 * i + 1] += (margin - lowest) / normal().y() + fall;
  }
  Vec3 velocity() const {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (int i = 0; i < state.particles(); ++i) {
      sum += system.masses()[i] * state.v.segment<3>(3 * i);
      mass += system.masses()[i];
    }
    return sum / mass;
  }
};

const Fabric poplin{.area_density = 0.12, .stretch = 500, .bend = 8e-6};

}  // namespace

TEST_CASE("cloth that lands on a slope loses mu times what the slope takes of its fall", "[contact]") {
  // All impulses of the slope together stop the fall onto it, and friction takes mu times as much, however it
  // lands.
  const double mu = 0.1, slope = pi / 6, duration = 0.7;  // s: where it bounces it lands late
  for (const bool of_springs : {false, true})
    for (const Kind kind : kinds)
      for (const int n : {6, 9, 13})
        for (const double h : {0.002, 0.005, 0.01}) {
          OnSlope sheet(n, kind, slope, mu, of_springs, poplin);
          sheet.let_go_level(0.2);
          ImplicitEuler stepper(sheet.system, sheet.constraints, make_linear_solver("mpcg+block-ic0"));
          INFO((of_springs ? "springs, " : "woven, ")
               << n << " x " << n << " of kind " << static_cast<int>(kind) << ", " << h << " s");
          for (int k = 0; k < std::lround(duration / h); ++k) {
            const double before = sheet.velocity().norm();
            const StepReport report = stepper.advance(sheet.state, h);
            REQUIRE(report.done);
            // What touches nothing is not slowed down.
            if (report.contacts == 0) CHECK(sheet.velocity().norm() > before);
          }
          CHECK(std::abs(sheet.velocity().dot(sheet.normal())) < 1e-3);
          CHECK(sheet.velocity().dot(sheet.down()) ==
                Approx(g * duration * (std::sin(slope) - mu * std::cos(slope))).epsilon(0.01));
        }
}

TEST_CASE("cloth that is laid at the margin holds below its static friction, by rounding or not",
          "[contact]") {
  const double slope = 24 * pi / 180;  // tan = 0.445
  for (const Kind kind : kinds)
    for (const int n : {6, 9, 13})
      for (const double h : {0.002, 0.01}) {
        OnSlope sheet(n, kind, slope, {0.5, 0.3}, false, poplin);
        sheet.lay();
        const VecX start = sheet.state.x;
        ImplicitEuler stepper(sheet.system, sheet.constraints, make_linear_solver("mpcg+block-ic0"));
        for (int k = 0; k < std::lround(0.1 / h); ++k) REQUIRE(stepper.advance(sheet.state, h).done);
        INFO(n << " x " << n << " of kind " << static_cast<int>(kind) << ", " << h << " s");
        CHECK((sheet.state.x - start).cwiseAbs().maxCoeff() < 1e-9);
      }
}

TEST_CASE("cloth that sticks comes loose where the slope is too steep, whatever the integrator",
          "[integrators]") {
  const double mu = 0.3, slope = pi / 4, duration = 0.1;
  const Fabric soft{.area_density = 0.3, .stretch = 10, .bend = 1e-6, .damping = 0.03};
  for (const Method& method : methods())
    for (const Kind kind : kinds) {
      const int n = kind == Kind::squares ? 5 : kind == Kind::equilateral ? 6 : 7;
      OnSlope sheet(n, kind, slope, mu, true, soft);
      sheet.lay();
      auto stepper = make_integrator(method.name, sheet.system, sheet.constraints, make_linear_solver("mpcg"),
                                     method.options());
      const double h = is_explicit(method.name) ? 1e-4 : 1e-3;
      INFO(method.label << ", kind " << static_cast<int>(kind));
      for (int k = 0; k < std::lround(duration / h); ++k) REQUIRE(stepper->advance(sheet.state, h).done);
      CHECK(sheet.velocity().dot(sheet.down()) ==
            Approx(g * duration * (std::sin(slope) - mu * std::cos(slope))).epsilon(0.03));
    }
}
