// Balls with mass on cloth: what pushes a ball goes through its centre, however it moves, so that cloth
// without friction neither turns it nor stops its spin; and with friction it rolls as on a slope. Against
// closed forms, on sheets of three kinds and sizes.
#include <catch2/catch.hpp>
#include <numbers>

#include "solver/forces/face_contact_force.h"
#include "solver/forces/woven.h"
#include "tests/integrators.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81, radius = 0.03, weight = 0.1, margin = 2e-3, size = 0.3;  // m/s^2, m, kg, m, m

const Fabric poplin{.area_density = 0.12, .stretch = 500, .bend = 8e-6};

// A level sheet, and a ball of 6 cm at x on it or just above it.
struct BallOnCloth {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  BallOnCloth(int n, Kind kind, const Vec3& gravity)
      : mesh(bent(n, kind, size, [](double, double) { return 0.0; })),
        system(lumped_mass(mesh, poplin.area_density)),
        state(at_rest(mesh)) {
    system.add(woven(mesh, mesh, poplin));
    system.add(Gravity{gravity});
    std::vector<ClothFace> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({{t[0], t[1], t[2]}, poplin.stretch});
    constraints.add_faces(faces);
  }
  void lay(const Vec3& centre, double friction, const Vec3& velocity, const Vec3& spin, const Vec3& gravity) {
    const RigidBody rigid{weight, 0.4 * weight * radius * radius * Mat3::Identity(), centre, velocity, spin,
                          gravity};
    constraints.add(
        {.shape = Sphere{centre, radius}, .friction = friction, .margin = margin, .rigid = rigid});
    system.add(face_contact_force(constraints));
  }
  void pin_all() {
    std::vector<int> all;
    for (int i = 0; i < state.particles(); ++i) all.push_back(i);
    constraints.pin(all);
  }
  void pin_corners() {
    for (const double x : {-size, size})
      for (const double z : {-size, size}) {
        int nearest = 0;
        for (int i = 0; i < state.particles(); ++i)
          if ((mesh.positions[i] - Vec3(x, 0, z)).norm() < (mesh.positions[nearest] - Vec3(x, 0, z)).norm())
            nearest = i;
        constraints.pin(nearest);
      }
  }
  void march(double duration, double h) {
    ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg+block-ic0"));
    for (int k = 0; k < std::lround(duration / h); ++k) {
      const StepReport report = stepper.advance(state, h);
      INFO(report.failure.what);
      REQUIRE(report.done);
    }
  }
  const ReactingBody& ball() const { return *constraints.bodies().back().reacting(); }
};

template <class F>  // f(n, kind, h)
void on_sheets(const F& f) {
  for (const Kind kind : kinds)
    for (const int n : {16, 23, 31})
      for (const double h : {0.01, 0.0025}) {
        INFO(n << " x " << n << " of kind " << static_cast<int>(kind) << ", " << h << " s");
        f(n, kind, h);
      }
}

}  // namespace

TEST_CASE("a ball that spins on hanging cloth without friction goes on spinning", "[reacting][faces]") {
  const Vec3 down(0, -g, 0), spin(0, 0, 20);
  on_sheets([&](int n, Kind kind, double h) {
    BallOnCloth all(n, kind, down);
    all.pin_corners();
    all.lay({0.002, radius + margin, 0.001}, 0, Vec3::Zero(), spin, down);
    all.march(0.25, h);
    CHECK((all.ball().spin() - spin).norm() < (h < 0.005 ? 0.6 : 2));
  });
}

TEST_CASE("a ball that is thrown over hanging cloth without friction does not spin", "[reacting]") {
  const Vec3 down(0, -g, 0);
  on_sheets([&](int n, Kind kind, double h) {
    BallOnCloth all(n, kind, down);
    all.pin_corners();
    all.lay({-0.08, radius + margin, 0.001}, 0, {1, 0, 0}, Vec3::Zero(), down);
    all.march(0.1, h);
    CHECK(radius * all.ball().spin().norm() < (h < 0.005 ? 0.04 : 0.12));
  });
}

TEST_CASE("a ball that is thrown over cloth that is held, without friction, gets neither spin nor speed",
          "[reacting][faces]") {
  const Vec3 down(0, -g, 0);
  on_sheets([&](int n, Kind kind, double h) {
    BallOnCloth all(n, kind, down);
    all.pin_all();
    all.lay({-0.08, radius + 0.5 * margin, 0.001}, 0, {1, 0, 0}, Vec3::Zero(), down);
    all.march(0.15, h);
    CHECK(radius * all.ball().spin().norm() < 0.02);
    CHECK(all.ball().velocity()[0] == Approx(1).epsilon(0.06));
  });
}

TEST_CASE("a ball rolls down cloth that is held as down a slope", "[reacting][faces]") {
  const double slope = 0.3;
  const Vec3 down(g * std::sin(slope), -g * std::cos(slope), 0);
  on_sheets([&](int n, Kind kind, double h) {
    BallOnCloth all(n, kind, down);
    all.pin_all();
    all.lay({-0.1, radius + 0.5 * margin, 0.001}, 0.5, Vec3::Zero(), Vec3::Zero(), down);
    all.march(0.35, h);
    const double off = n < 20 ? 0.1 : 0.06;  // edges of 20 mm are large for a ball of 6 cm
    CHECK(all.ball().velocity()[0] == Approx(5.0 / 7 * down[0] * 0.35).epsilon(off));
  });
}

TEST_CASE("a ball that is thrown over cloth on a table, without friction, does not spin and slides on",
          "[reacting][faces]") {
  const Vec3 down(0, -g, 0);
  on_sheets([&](int n, Kind kind, double h) {
    BallOnCloth all(n, kind, down);
    all.constraints.add({.shape = Plane{{0, -margin, 0}}, .friction = 0.8, .margin = margin});
    all.lay({-0.08, radius + margin, 0.001}, 0, {1, 0, 0}, Vec3::Zero(), down);
    all.march(0.15, h);
    CHECK(radius * all.ball().spin().norm() < 1e-3);
    CHECK(all.ball().velocity()[0] < 1.01);
    CHECK(all.ball().velocity()[0] > 0.99);
  });
}
