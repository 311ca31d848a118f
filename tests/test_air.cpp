// Air drag and wind: laws of the force, falls to the terminal velocity, and a sheet that hangs in the wind.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/base/errors.h"
#include "solver/assembly/assembly.h"
#include "solver/forces/air.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/woven.h"
#include "tests/integrators.h"
#include "tests/strips.h"
#include "tests/tearing.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double density = 0.2, g = 9.81;  // kg/m^2, m/s^2
const Fabric cloth{.area_density = density, .stretch = 500, .bend = 1e-5};

double terminal(const Air& air) { return std::sqrt(2 * density * g / (air.density * air.drag)); }

// One triangle: all its particles always feel the same. (A sheet of loose particles that falls flat is
// unstable.)
TriangleMesh triangle() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.2}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

struct Fall {
  double v = 0;       // m/s, downwards, at the end
  double spread = 0;  // m/s, by which particles differ from the mean
  double worst = 0;   // m/s, largest difference from v_t tanh(g t / v_t) on the way
};

// A sheet that falls flat from rest for a time t [s].
Fall fall(const TriangleMesh& mesh, System& system, const std::string& integrator, double h, double t) {
  Constraints constraints;
  auto stepper = make_integrator(integrator, system, constraints, make_linear_solver("mpcg+block-ic0"),
                                 {.tolerance = 1e-10});
  State state = at_rest(mesh);
  Fall all;
  const double v_t = terminal({});
  for (int step = 0; step < std::lround(t / h); ++step) {
    const StepReport report = stepper->advance(state, h);
    INFO(integrator << ": " << report.failure.what);
    REQUIRE(report.done);
    CHECK(report.rescues == 0);
    all.v = 0;
    for (int i = 0; i < state.particles(); ++i) all.v -= state.v[3 * i + 1] / state.particles();
    all.worst = std::max(all.worst, std::abs(all.v - v_t * std::tanh(g * state.time / v_t)));
  }
  for (int i = 0; i < state.particles(); ++i)
    all.spread = std::max(all.spread, std::abs(all.v + state.v[3 * i + 1]));
  return all;
}

Fall fall(const TriangleMesh& mesh, const std::string& integrator, double h, double t, bool with_fabric) {
  System system(masses(mesh, cloth));
  if (with_fabric) system.add(woven(mesh, mesh, cloth));
  std::vector<std::unique_ptr<Force>> drag;
  drag.push_back(air_drag(mesh, {}));
  system.add(std::move(drag));
  system.add(Gravity{});
  return fall(mesh, system, integrator, h, t);
}

}  // namespace

TEST_CASE("the force of the air is minus the slope of its power, and its matrix the slope of the force",
          "[air][forces]") {
  const TriangleMesh mesh = strip(StripMesh::irregular, 4, 3, 0.3).mesh;
  const Eigen::Index n = 3 * mesh.vertex_count();
  System system(masses(mesh, cloth));
  std::vector<std::unique_ptr<Force>> drag;
  drag.push_back(air_drag(mesh, {.wind = {1, -0.5, 2}, .drag = 1.1, .skin_friction = 0.3}));
  system.add(std::move(drag));
  const Force& air = *system.forces()[0];
  const VecX x = stacked(mesh.positions) + random_vector(n, 0.02, 3), still = VecX::Zero(n);
  for (const VecX& v : {VecX(still), random_vector(n, 3, 4)}) {
    system.begin_step({0, 0.01, x, v, 0.01});
    VecX f = still, up = still, down = still;
    air.add_force(x, v, f);
    BlockMatrix A = system.matrix();
    A.set_to_mass(std::vector<double>(system.masses().size(), 0.0));
    VecX b = still, rows(n), product(n), column(n);
    const double c = 0.1, d = 1e-5;
    air.add_linearised(x, v, still, c, Stiffness::tangent, A, b);
    CHECK((b - c * f).norm() < 1e-13 * b.norm());
    Eigen::MatrixXd D(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      VecX more = v, less = v;
      more[k] += d;
      less[k] -= d;
      CHECK(f[k] == Approx(-(air.dissipation(x, more) - air.dissipation(x, less)) / (2 * d)).margin(1e-9));
      to_rows(A.pattern(), VecX(VecX::Unit(n, k)), rows);
      A.multiply(rows, product);
      to_particles(A.pattern(), product, column);
      D.col(k) = column / c;
      up.setZero();
      down.setZero();
      air.add_force(x, more, up);
      air.add_force(x, less, down);
      CHECK((D.col(k) + (up - down) / (2 * d)).norm() < 1e-7 * D.norm());
    }
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(D).eigenvalues().minCoeff() > -1e-13 * D.norm());
    CHECK(air.given_power(x, v) >= 0);
  }
  CHECK(air.given_power(x, still) == 0);
}

TEST_CASE(
    "a sheet that falls flat comes to its terminal velocity as tanh, on every mesh, by every integrator",
    "[air]") {
  const double v_t = terminal({});
  CHECK(v_t == Approx(1.6508).epsilon(1e-4));
  for (const std::string& integrator : integrator_names()) {
    INFO(integrator);
    const Fall once = fall(triangle(), integrator, 0.005, 1.5, false);
    CHECK(once.v == Approx(v_t).epsilon(1e-5));
    // Of first order: less than h g / 2.
    CHECK(once.worst < (order_of(integrator) == 1 ? 0.5 * 0.005 * g : 1e-3));
  }
  // With a fabric, whatever its mesh and however its triangles are wound.
  for (StripMesh kind : strip_meshes)
    for (bool turned : {false, true}) {
      INFO(name(kind) << (turned ? ", wound the other way" : ""));
      TriangleMesh mesh = strip(kind, 6, 4, 0.2).mesh;
      if (turned)
        for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
      const Fall one = fall(mesh, "bdf2", 0.01, 0.3, true);
      CHECK(one.v == Approx(v_t * std::tanh(g * 0.3 / v_t)).epsilon(2e-3));
      CHECK(one.spread < 1e-6);
    }
  const auto worst = [&](const std::string& integrator, double h) {
    return fall(triangle(), integrator, h, 0.6, false).worst;
  };
  CHECK(worst("bdf2", 0.01) / worst("bdf2", 0.005) > 3);
  CHECK(worst("implicit-euler", 0.01) / worst("implicit-euler", 0.005) > 1.8);
}

TEST_CASE("a grid of quads that falls flat stays flat, however its quads are cut and wound", "[air]") {
  const double v_t = terminal({});
  for (const auto& [nx, nz] : {std::pair{5, 4}, {9, 9}, {16, 7}})
    for (const bool turned : {false, true}) {
      INFO(nx << " x " << nz << (turned ? ", wound the other way" : ""));
      TriangleMesh mesh = quad_sheet(nx, nz, 0.03);
      if (turned)
        for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
      System system(choi_ko_mass(mesh, mesh, density));
      system.add(choi_ko(mesh, cloth));
      std::vector<std::unique_ptr<Force>> drag;
      drag.push_back(air_drag_of_quads(mesh, {}));
      system.add(std::move(drag));
      system.add(Gravity{});
      const Fall one = fall(mesh, system, "bdf2", 0.01, 0.3);
      CHECK(one.v == Approx(v_t * std::tanh(g * 0.3 / v_t)).epsilon(2e-3));
      CHECK(one.spread < 1e-9);
    }
  // And as a scene puts it together.
  Assembly sheet({0, -g, 0}, {}, Air{});
  sheet.add({.mesh = quad_sheet(9, 6, 0.03), .fabric = cloth, .model = ClothModel::choi_ko});
  sheet.use("implicit-euler", "auto", {});
  while (sheet.state.time < 0.2) REQUIRE(sheet.advance(0.01).done);
  for (int i = 0; i < sheet.state.particles(); ++i)
    CHECK(sheet.state.v[3 * i + 1] == Approx(sheet.state.v[1]).epsilon(1e-9));
}

TEST_CASE("still air takes energy and never gives any", "[air]") {
  const TriangleMesh mesh = grid(13, 13, 0.5, 0.5);
  for (ClothModel model : {ClothModel::woven, ClothModel::noh_jung}) {
    Assembly all({0, -g, 0}, {}, Air{.skin_friction = 0.1});
    all.add(ClothPart{.mesh = mesh, .fabric = cloth, .model = model});
    all.pin(PinVertices{{0, 12}});
    all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-9});
    double before = all.system->total_energy(all.state);
    const double scale = std::abs(before) + 1;
    for (int step = 0; step < 150; ++step) {
      REQUIRE(all.advance(0.01).done);
      const double after = all.system->total_energy(all.state);
      CHECK(after <= before + 1e-9 * scale);
      before = after;
    }
  }
}

TEST_CASE("a sheet that hangs in the wind stands at the angle at which its weight balances the wind",
          "[air]") {
  // Pressure is p = rho C U^2 cos^2(a) / 2 on every part alike, so that the sheet stays straight: sin a = p /
  // (sigma g).
  const TriangleMesh lying = grid(7, 11, 0.15, 0.25);
  TriangleMesh mesh = lying;
  for (Vec3& x : mesh.positions) x = Vec3(x.x(), x.z(), 0);
  std::vector<int> top;
  for (int i = 0; i < 7; ++i) top.push_back(70 + i);
  for (double speed : {0.5, 1.0, 2.0}) {
    const Air air{.wind = {0, 0, speed}};
    Assembly all({0, -g, 0}, {}, air);
    Fabric fabric = cloth;
    fabric.weave.bend_time = 0.1;
    all.add(ClothPart{.mesh = mesh, .fabric = fabric, .model = ClothModel::woven});
    all.pin(PinVertices{top});
    all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-8});
    for (int step = 0; step < 400; ++step) REQUIRE(all.advance(0.02).done);
    double sine = 0;
    for (int k = 0; k < 100; ++k)
      sine = air.density * air.drag * speed * speed * (1 - sine * sine) / (4 * density * g) + 0.5 * sine;
    const Vec3 along = all.state.x.segment<3>(3 * 3) - all.state.x.segment<3>(3 * 73);
    INFO(speed << " m/s");
    CHECK(along.z() / along.norm() == Approx(sine).epsilon(0.01));
    CHECK(std::abs(along.x()) < 1e-4);
  }
}

TEST_CASE("what the wind gives is no mistake: nothing is rescued, nothing explodes", "[air]") {
  const TriangleMesh mesh = triangle();
  for (const std::string& name : integrator_names()) {
    System system(masses(mesh, cloth));
    std::vector<std::unique_ptr<Force>> drag;
    drag.push_back(air_drag(mesh, {.wind = {0, 4, 0}}));
    system.add(std::move(drag));  // without gravity
    Constraints constraints;
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg+block-ic0"), {});
    State state = at_rest(mesh);
    for (int step = 0; step < 200; ++step) {
      const StepReport report = stepper->advance(state, 0.005);
      INFO(name << ": " << report.failure.what);
      REQUIRE(report.done);
      CHECK(report.rescues == 0);
    }
    // v = U^2 k t / (1 + U k t), k = rho C / (2 sigma)
    const double k = 1.2 * 1.2 / (2 * density);
    INFO(name);
    CHECK(state.v[1] == Approx(16 * k / (1 + 4 * k)).epsilon(0.01));
  }
}

TEST_CASE("air that makes no sense is refused by name", "[air]") {
  const TriangleMesh mesh = grid(3, 3, 1, 1);
  CHECK_THROWS_WITH(air_drag(mesh, {.density = -1}), Catch::Contains("density = -1 kg/m^3"));
  CHECK_THROWS_WITH(air_drag(mesh, {.drag = NAN}), Catch::Contains("drag"));
  CHECK_THROWS_WITH(air_drag(mesh, {.skin_friction = -0.1}), Catch::Contains("skin_friction = -0.1"));
  CHECK_THROWS_WITH(air_drag(mesh, {.wind = {INFINITY, 0, 0}}), Catch::Contains("wind"));
}
