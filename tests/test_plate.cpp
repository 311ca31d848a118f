// The force of bending, by a plate or by hinges, flat at rest and bent at rest: laws of its energy, its
// matrix and its rest shape.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/base/errors.h"
#include "solver/assembly/assembly.h"
#include "solver/forces/plate_force.h"
#include "solver/forces/woven.h"
#include "tests/dense.h"
#include "tests/strips.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr std::array bendings_at_angles = {Bending::plate, Bending::hinges};

const char* name(Bending bending) {
  constexpr std::array names = {"plate", "hinges", "quadratic hinges"};
  return names[static_cast<std::size_t>(bending)];
}

Fabric stiff(double rest_angle, Bending bending = Bending::plate) {
  Fabric fabric{.area_density = 0.2, .stretch = 300, .bend = 1};
  fabric.weave.rest_angle = rest_angle;
  fabric.weave.bending = bending;
  return fabric;
}

// A sheet in waves and with a crease, on a mesh of that kind.
TriangleMesh folded(StripMesh kind) {
  TriangleMesh mesh = strip(kind, 6, 5, 0.3).mesh;
  for (Vec3& x : mesh.positions)
    x.y() = 0.03 * std::sin(20 * x.x() + 8 * x.z()) + 0.3 * std::abs(x.z() - 0.1) - 0.4 * x.x() * x.x();
  return mesh;
}

// The rest shape of a folded mesh, flat: its triangles keep their shape.
std::unique_ptr<Force> plate_of_mesh(const TriangleMesh& mesh, const Fabric& fabric) {
  for (std::unique_ptr<Force>& force : woven(mesh, mesh, fabric))
    if (force->name() == "bend") return std::move(force);
  FAIL("there is no plate");
  return {};
}

VecX pushed(const Force& force, const VecX& x) {
  VecX f = VecX::Zero(x.size());
  force.add_force(x, VecX::Zero(x.size()), f);
  return f;
}

VecX moved(const TriangleMesh& mesh) {
  const Eigen::AngleAxisd turn(2.1, Vec3(1, -2, 0.5).normalized());
  std::vector<Vec3> all;
  for (const Vec3& x : mesh.positions) all.push_back(turn * x + Vec3(0.3, 1, -2));
  return stacked(all);
}

}  // namespace

TEST_CASE(
    "the force of bending is minus the slope of its energy, bent at rest or flat, and turns and moves "
    "nothing",
    "[woven][forces]") {
  for (StripMesh kind : strip_meshes)
    for (const auto& [bending, rest_angle] : {std::pair{Bending::plate, 0.0},
                                              {Bending::plate, 0.3},
                                              {Bending::plate, 1.0},
                                              {Bending::hinges, 0.0},
                                              {Bending::hinges, 0.3},
                                              {Bending::hinges, 1.0},
                                              {Bending::quadratic_hinges, 0.0}}) {
      INFO(name(kind) << ", " << name(bending) << ", rest angle " << rest_angle);
      const TriangleMesh mesh = folded(kind);
      const auto plate = plate_of_mesh(mesh, stiff(rest_angle, bending));
      const VecX x = moved(mesh) + random_vector(3 * mesh.vertex_count(), 0.01, 7);
      const VecX f = pushed(*plate, x);
      double worst = 0;
      for (Eigen::Index k = 0; k < x.size(); ++k) {
        VecX up = x, down = x;
        up[k] += 1e-6;
        down[k] -= 1e-6;
        worst = std::max(worst, std::abs(f[k] + (plate->energy(up) - plate->energy(down)) / 2e-6));
      }
      CHECK(worst < 1e-6 * f.lpNorm<Eigen::Infinity>());
      Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
      for (Eigen::Index i = 0; i < x.size(); i += 3) {
        sum += f.segment<3>(i);
        torque += x.segment<3>(i).cross(f.segment<3>(i));
      }
      CHECK(sum.norm() < 1e-11 * f.norm());
      CHECK(torque.norm() < 1e-11 * f.norm());
    }
}

TEST_CASE("a cloth that rests in the shape of its mesh is in equilibrium there, wherever it is moved to",
          "[woven]") {
  for (StripMesh kind : strip_meshes)
    for (Bending bending : bendings_at_angles) {
      INFO(name(kind) << ", " << name(bending));
      const TriangleMesh mesh = folded(kind);
      const auto flat = plate_of_mesh(mesh, stiff(0, bending)), bent = plate_of_mesh(mesh, stiff(1, bending)),
                 half = plate_of_mesh(mesh, stiff(0.5, bending));
      for (const VecX& x : {stacked(mesh.positions), moved(mesh)}) {
        const VecX all = pushed(*flat, x);
        REQUIRE(all.norm() > 1);
        CHECK(pushed(*bent, x).norm() < 1e-11 * all.norm());
        CHECK(std::abs(bent->energy(x)) < 1e-11 * flat->energy(x));
        CHECK(half->energy(x) == Approx(0.25 * flat->energy(x)));
      }
      // A flat mesh has no angle to rest with, whatever is asked.
      TriangleMesh plane = mesh;
      for (Vec3& x : plane.positions) x.y() = 0;
      const VecX x = stacked(mesh.positions);
      CHECK(pushed(*plate_of_mesh(plane, stiff(1, bending)), x) ==
            pushed(*plate_of_mesh(plane, stiff(0, bending)), x));
    }
}

TEST_CASE(
    "the matrix of a plate is that of its stiffness, and the right side its force at the end of the step",
    "[woven][forces]") {
  for (double rest_angle : {0.0, 1.0}) {
    const TriangleMesh mesh = folded(StripMesh::irregular);
    Fabric fabric = stiff(rest_angle);
    const double T = 0.02, c = 0.1;
    fabric.weave.bend_time = T;
    System system(masses(mesh, fabric));
    fabric.stretch = 0;
    system.add(woven(mesh, mesh, fabric));
    REQUIRE(system.forces().size() == 1);
    const Force& plate = *system.forces()[0];
    const Eigen::Index n = 3 * mesh.vertex_count();
    const VecX x = moved(mesh), v = random_vector(n, 1, 4), y = random_vector(n, 0.01, 5),
               still = VecX::Zero(n);
    BlockMatrix A = system.matrix();
    A.set_to_mass(std::vector<double>(system.masses().size(), 0.0));
    VecX b = still, f = still, unmoved = still;
    plate.add_linearised(x, v, y, c, Stiffness::tangent, A, b);
    plate.add_force(x + y, v, f);
    CHECK((b - c * f).norm() < 1e-12 * (1 + b.norm()));
    const Eigen::MatrixXd K = dense(A) / (c * (c + T));
    CHECK((K - K.transpose()).norm() < 1e-14 * K.norm());
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff() > -1e-12 * K.norm());
    plate.add_force(x, v, unmoved);
    CHECK((unmoved - pushed(plate, x) + T * K * v).norm() < 1e-11 * (1 + b.norm()));
    CHECK(plate.dissipation(x, v) == Approx(0.5 * T * v.dot(K * v)));
    if (rest_angle == 0) CHECK((pushed(plate, x) + K * x).norm() < 1e-11 * (1 + (K * x).norm()));
  }
}

TEST_CASE("a fold stays where it is at rest, opens where the cloth rests flat, and comes back when laid flat",
          "[woven]") {
  // Two wings with 60 degrees between each and the plane, of cloth that is hardly stretched.
  const TriangleMesh plane = grid(9, 5, 0.2, 0.1);
  TriangleMesh fold = plane;
  for (Vec3& x : fold.positions) x = Vec3(0.5 * x.x(), std::sqrt(0.75) * std::abs(x.x()), x.z());
  const auto opening = [](const VecX& x) {  // of the edges of both wings, from one another
    return (x.segment<3>(3 * (9 * 2 + 8)) - x.segment<3>(3 * (9 * 2))).norm();
  };
  const auto run = [&](Bending bending, const TriangleMesh& start, double rest_angle) {
    Assembly all({0, 0, 0});
    Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-4};
    fabric.weave.rest_angle = rest_angle;
    fabric.weave.bending = bending;
    fabric.weave.bend_time = 0.01;
    all.add(ClothPart{.mesh = fold, .fabric = fabric, .model = ClothModel::woven, .imperfection = 0});
    all.state.x = stacked(start.positions);
    all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-10});
    double before = all.system->total_energy(all.state);
    for (int step = 0; step < 200; ++step) {
      REQUIRE(all.advance(0.01).done);
      const double after = all.system->total_energy(all.state);
      CHECK(after <= before + 1e-9);
      before = after;
    }
    return opening(all.state.x);
  };
  for (Bending bending : bendings_at_angles) {
    INFO(name(bending));
    CHECK(run(bending, fold, 1) == Approx(0.1).epsilon(1e-9));
    CHECK(run(bending, fold, 0) > 0.19);
    CHECK(run(bending, plane, 1) < 0.12);
    const double half = run(bending, fold, 0.5);
    CHECK(half > 0.13);
    CHECK(half < 0.19);
  }
  CHECK(run(Bending::quadratic_hinges, fold, 0) > 0.19);
}

TEST_CASE("cloth that rests bent spins as a rigid body does", "[woven]") {
  TriangleMesh roll = grid(13, 5, 0.1, 0.05);
  const double R = 0.03;  // m
  for (Vec3& x : roll.positions) x = Vec3(R * std::sin(x.x() / R), R * std::cos(x.x() / R), x.z());
  Assembly all({0, 0, 0});
  Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-4};
  fabric.weave.rest_angle = 1;
  all.add(ClothPart{.mesh = roll, .fabric = fabric, .model = ClothModel::woven, .imperfection = 0});
  // One solve a step slows every sheet that spins out of its plane; five let a bent one show what it does
  // itself.
  all.use("implicit-euler", "mpcg+block-ic0", {.newton_iterations = 5, .tolerance = 1e-10});
  const auto momentum = [&] {
    Vec3 L = Vec3::Zero();
    for (int i = 0; i < all.state.particles(); ++i)
      L += all.system->masses()[static_cast<std::size_t>(i)] *
           all.state.x.segment<3>(3 * i).cross(all.state.v.segment<3>(3 * i));
    return L;
  };
  const double h = 0.01, spin = 1;  // s, rad/s
  for (int i = 0; i < all.state.particles(); ++i)
    all.state.v.segment<3>(3 * i) = spin * Vec3::UnitX().cross(all.state.x.segment<3>(3 * i));
  const double before = momentum().norm();
  for (int step = 0; step < 100; ++step) REQUIRE(all.advance(h).done);
  // Implicit Euler slows a rigid body to 1 / sqrt(1 + 2 h omega^2 t) of its momentum.
  CHECK(momentum().norm() / before > 1 / std::sqrt(1 + 2 * h * spin * spin) - 0.005);
}

TEST_CASE(
    "a fine and stiff sheet without gravity, where energies are as small as their round-off, keeps going",
    "[woven]") {
  for (const auto& [edge, far] : {std::pair{1e-3, 0.0}, {2e-3, 0.0}, {1e-3, 1.0}})
    for (Bending bending : {Bending::plate, Bending::hinges, Bending::quadratic_hinges})
      for (std::optional<double> imperfection : {std::optional<double>(0.0), std::optional<double>()}) {
        INFO("edges of " << edge << " m, " << name(bending) << ", " << far << " m away, imperfection "
                         << imperfection.value_or(-1));
        Assembly all({0, 0, 0});
        TriangleMesh sheet = grid(21, 21, 20 * edge, 20 * edge);
        for (Vec3& x : sheet.positions) x.x() += far;
        Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-4};
        fabric.weave.bending = bending;
        all.add(ClothPart{
            .mesh = sheet, .fabric = fabric, .model = ClothModel::woven, .imperfection = imperfection});
        all.use("implicit-euler", "auto", {.tolerance = 1e-4});
        for (int step = 0; step < 60; ++step) {
          const StepReport report = all.advance(0.01);
          INFO(report.failure.what);
          REQUIRE(report.done);
        }
        CHECK((all.state.x - stacked(sheet.positions)).lpNorm<Eigen::Infinity>() < 1e-5);
      }
}

TEST_CASE("a rest angle that makes no sense is refused", "[woven]") {
  const TriangleMesh mesh = grid(3, 3, 1, 1);
  for (double bad : {-0.1, 1.1, double(NAN)})
    CHECK_THROWS_WITH(woven(mesh, mesh, stiff(bad)), Catch::Contains("rest_angle"));
  CHECK_THROWS_WITH(woven(mesh, mesh, stiff(0.5, Bending::quadratic_hinges)),
                    Catch::Contains("quadratic hinges rest flat"));
}
