// Laws of cloth whose faces are clusters: what its stiffness means, what a projection keeps, and what many of
// them come to.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/base/errors.h"
#include "mesh/triangles/topology.h"
#include "solver/assembly/assembly.h"
#include "solver/forces/cluster.h"
#include "solver/forces/face_clusters.h"
#include "solver/forces/woven.h"
#include "tests/same_bits.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double Y = 400;  // N/m

TriangleMesh flat(int n, Kind kind) {
  return bent(n, kind, 0.4, [](double, double) { return 0; });
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
  return sum;
}

std::unique_ptr<FaceClusterForce> faces_of(const TriangleMesh& mesh, double viscosity = 0) {
  return std::make_unique<FaceClusterForce>(face_clusters(mesh, mesh, Y), viscosity);
}

// The sheet pulled along the direction n by the strain e.
VecX pulled(const TriangleMesh& mesh, const Vec3& n, double e) {
  VecX x = stacked(mesh.positions);
  for (int i = 0; i < mesh.vertex_count(); ++i)
    x.segment<3>(3 * i) += e * n.dot(Vec3(x.segment<3>(3 * i))) * n;
  return x;
}

// A sheet of clusters in flight.
struct Sheets {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;
  explicit Sheets(TriangleMesh m, double viscosity = 0, double g = 0)
      : mesh(std::move(m)),
        system(lumped_mass(mesh, 0.2)),
        state{0, stacked(mesh.positions), VecX::Zero(3 * mesh.vertex_count())} {
    system.add(faces_of(mesh, viscosity));
    system.add(Gravity{{0, -g, 0}});
  }
  StepReport step(int substeps, int iterations, double h) {
    StepOptions options;
    options.projection.substeps = substeps;
    options.projection.iterations = iterations;
    return make_integrator("pbd", system, constraints, make_linear_solver("mpcg"), options)
        ->advance(state, h);
  }
  Vec3 angular() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < system.particles(); ++i)
      sum += system.masses()[static_cast<std::size_t>(i)] *
             Vec3(state.x.segment<3>(3 * i)).cross(Vec3(state.v.segment<3>(3 * i)));
    return sum;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < system.particles(); ++i)
      sum += system.masses()[static_cast<std::size_t>(i)] * state.v.segment<3>(3 * i);
    return sum;
  }
};

}  // namespace

TEST_CASE("what is strained alike in all directions has the energy Y e^2 per area, on any mesh",
          "[clusters]") {
  for (const Kind kind : kinds)
    for (const int n : {4, 9, 20})
      for (const double e : {-0.3, -1e-4, 1e-4, 0.05, 0.5}) {
        const TriangleMesh mesh = flat(n, kind);
        INFO("kind " << static_cast<int>(kind) << ", " << n << ", e = " << e);
        CHECK(faces_of(mesh)->energy((1 + e) * stacked(mesh.positions)) ==
              Approx(Y * e * e * area(mesh)).epsilon(1e-9));
      }
}

TEST_CASE("a pull in any direction has the energy Y e^2 / 2 per area, on any mesh", "[clusters]") {
  for (const Kind kind : kinds)
    for (const int n : {4, 9, 20})
      for (int k = 0; k < 12; ++k)
        for (const double e : {-0.2, 1e-3, 0.3}) {
          const TriangleMesh mesh = flat(n, kind);
          const double angle = M_PI * k / 12;
          INFO("kind " << static_cast<int>(kind) << ", " << n << ", " << angle << ", e = " << e);
          CHECK(faces_of(mesh)->energy(pulled(mesh, {std::cos(angle), 0, std::sin(angle)}, e)) ==
                Approx(Y / 2 * e * e * area(mesh)).epsilon(1e-9));
        }
}

TEST_CASE("of equal edges it is the sum of squares to the goals", "[clusters]") {
  const TriangleMesh mesh = equilateral_sheet(2, 2, 0.1);
  const FaceClusterForce one({face_clusters(mesh, mesh, Y)[0]});
  const Triangle& t = mesh.triangles[0];
  std::vector<Vec3> rest;
  Vec3 c = Vec3::Zero();
  for (int v : t) rest.push_back(mesh.positions[static_cast<std::size_t>(v)]), c += rest.back() / 3;
  double moment = 0;
  for (Vec3& b : rest) moment += (b -= c).squaredNorm();
  const double kappa = 2 * Y * triangle_area(mesh, t) / moment;
  const Clusters cluster({{0, 1, 2}}, {1, 1, 1}, stacked(rest), "face");
  for (unsigned seed = 0; seed < 20; ++seed) {
    const VecX x = stacked(rest) + random_vector(9, 0.03, seed);
    VecX all = VecX::Zero(3 * mesh.vertex_count());
    for (int k = 0; k < 3; ++k) all.segment<3>(3 * t[static_cast<std::size_t>(k)]) = x.segment<3>(3 * k);
    const ClusterPose pose = matched(cluster[0], x, Quaternion::Identity());
    CHECK(one.energy(all) == Approx(energy(cluster[0], pose, x, kappa)).epsilon(1e-9));
  }
}

TEST_CASE("the force of faces that are clusters is the slope of their energy", "[clusters]") {
  for (const Kind kind : kinds) {
    const TriangleMesh mesh = flat(6, kind);
    const auto force = faces_of(mesh);
    const VecX x = stacked(mesh.positions) + random_vector(3 * mesh.vertex_count(), 0.02, 3),
               way = random_vector(x.size(), 1, 4);
    constexpr double s = 1e-7;
    VecX f = VecX::Zero(x.size());
    force->add_force(x, VecX::Zero(x.size()), f);
    CHECK(-f.dot(way) ==
          Approx((force->energy(x + s * way) - force->energy(x - s * way)) / (2 * s)).epsilon(1e-5));
  }
}

TEST_CASE("a rigid motion and a fold cost faces nothing", "[clusters]") {
  const TriangleMesh mesh = flat(7, Kind::squares);
  const auto force = faces_of(mesh);
  const Eigen::Quaterniond q(Eigen::AngleAxisd(2.1, Vec3(1, 2, -0.5).normalized()));
  VecX moved = stacked(mesh.positions), folded = moved;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 at = mesh.positions[static_cast<std::size_t>(i)];
    moved.segment<3>(3 * i) = q * at + Vec3(3, 2, 1);
    if (at[0] > 0) folded.segment<3>(3 * i) = Vec3(0.6 * at[0], 0.8 * at[0], at[2]);
  }
  CHECK(force->energy(moved) < 1e-25);
  CHECK(force->energy(folded) < 1e-25);
}

TEST_CASE("one face keeps momentum and angular momentum, with unequal masses", "[clusters]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0.1, 0, 0}, {0.02, 0, 0.07}};
  mesh.triangles = {{0, 1, 2}};
  for (const double viscosity : {0.0, 0.01})
    for (unsigned seed = 0; seed < 50; ++seed) {
      Sheets one(mesh, viscosity);
      one.system = System({0.1, 0.7, 0.02});
      one.system.add(faces_of(mesh, viscosity));
      one.state.x += random_vector(9, 0.05, seed);
      const VecX before = one.state.x;
      REQUIRE(one.step(1, 1, 0.003).done);
      INFO(viscosity << ", " << seed);
      CHECK((one.state.x - before).norm() > 1e-4);
      CHECK(one.momentum().norm() < 1e-12);
      CHECK(one.angular().norm() < 1e-12);
    }
}

TEST_CASE("with many iterations faces take the step of implicit Euler, pins included", "[clusters][pbd]") {
  for (const Kind kind : kinds)
    for (const double h : {0.001, 0.01}) {
      Sheets sheet(flat(6, kind), 0, 9.81);
      sheet.state.x += random_vector(sheet.state.x.size(), 0.005, 5);
      sheet.state.v = random_vector(sheet.state.x.size(), 0.5, 6);
      sheet.constraints.pin({0, 5});
      const State before = sheet.state;
      REQUIRE(sheet.step(1, 6000, h).done);
      const VecX f = sheet.system.force(sheet.state.x, sheet.state.v);
      double left = 0, all = 0;
      for (int i = 0; i < sheet.system.particles(); ++i) {
        if (i == 0 || i == 5) continue;
        const Vec3 change = sheet.system.masses()[static_cast<std::size_t>(i)] / h *
                            (sheet.state.v.segment<3>(3 * i) - before.v.segment<3>(3 * i));
        left += (change - f.segment<3>(3 * i)).squaredNorm();
        all += change.squaredNorm();
      }
      INFO("kind " << static_cast<int>(kind) << ", h = " << h);
      CHECK(std::sqrt(left / all) < 1e-7);
      CHECK(sheet.state.x.head<3>() == before.x.head<3>());
    }
}

TEST_CASE("a strip of faces that hangs is as long as its weight and stiffness say", "[clusters][pbd]") {
  for (const Kind kind : kinds) {
    Sheets strip(flat(6, kind), 0.002, 40);                // w L^2 / 2 Y
    for (int i = 0; i < strip.mesh.vertex_count(); ++i) {  // stood up, z down
      const Vec3 at = strip.mesh.positions[static_cast<std::size_t>(i)];
      strip.state.x.segment<3>(3 * i) = Vec3(at[0], -at[2], 0);
    }
    double top = -1, bottom = 1;
    for (int i = 0; i < strip.mesh.vertex_count(); ++i) {
      top = std::max(top, strip.state.x[3 * i + 1]), bottom = std::min(bottom, strip.state.x[3 * i + 1]);
    }
    std::vector<int> held, low;
    for (int i = 0; i < strip.mesh.vertex_count(); ++i) {
      if (strip.state.x[3 * i + 1] > top - 0.03) held.push_back(i);
      if (strip.state.x[3 * i + 1] < bottom + 0.03) low.push_back(i);
    }
    strip.constraints.pin(held);
    const VecX start = strip.state.x;
    StepOptions options;
    options.projection.substeps = 20;
    options.projection.iterations = 2;
    auto stepper =
        make_integrator("pbd", strip.system, strip.constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < 300; ++n) REQUIRE(stepper->advance(strip.state, 0.01).done);
    double longer = 0, expected = 0;
    for (const int i : low) {
      const double length = top - start[3 * i + 1];
      longer += (start[3 * i + 1] - strip.state.x[3 * i + 1]) / static_cast<double>(low.size());
      expected += 0.2 * 40 * length * length / (2 * Y) / static_cast<double>(low.size());
    }
    INFO("kind " << static_cast<int>(kind));
    CHECK(longer == Approx(expected).epsilon(kind == Kind::irregular ? 0.12 : 0.03));
  }
}

TEST_CASE("faces on a line or at one place stay finite and open again", "[clusters][pbd]") {
  Sheets sheet(flat(5, Kind::irregular));
  for (int i = 0; i < sheet.mesh.vertex_count(); ++i) {
    sheet.state.x[3 * i + 2] = 0;
    if (i % 3 == 0) sheet.state.x.segment<3>(3 * i).setZero();
  }
  const double before = sheet.system.elastic_energy(sheet.state.x);
  REQUIRE(std::isfinite(before));
  for (int n = 0; n < 20; ++n) REQUIRE(sheet.step(20, 1, 0.005).done);
  CHECK(sheet.state.x.allFinite());
  CHECK(sheet.system.total_energy(sheet.state) < before);
}

TEST_CASE("viscosity of faces resists no rigid motion and takes the energy of the rest", "[clusters][pbd]") {
  const auto after = [](double viscosity, bool rigid) {
    Sheets sheet(flat(6, Kind::equilateral), viscosity);
    for (int i = 0; i < sheet.mesh.vertex_count(); ++i) {
      const Vec3 at = sheet.state.x.segment<3>(3 * i);
      sheet.state.v.segment<3>(3 * i) =
          rigid ? Vec3(Vec3(0.3, 0.2, 0.1) + Vec3(0.01, 0.02, 0.03).cross(at)) : Vec3(0.5 * at);
    }
    for (int n = 0; n < 50; ++n) REQUIRE(sheet.step(10, 1, 0.001).done);
    return sheet.system.total_energy(sheet.state);
  };
  CHECK(after(0.02, true) == Approx(after(0, true)).epsilon(1e-6));
  CHECK(after(0.02, false) < 0.2 * after(0, false));
}

TEST_CASE("cloth of clusters bends as its model has it, and needs pbd", "[clusters]") {
  for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven}) {
    const auto assembly = [&](bool clusters, double stretch) {
      auto all = std::make_unique<Assembly>();
      Fabric fabric{.stretch = stretch, .bend = 1e-4};
      all->add(ClothPart{.mesh = flat(7, Kind::squares),
                         .fabric = fabric,
                         .model = model,
                         .imperfection = 0.0,
                         .clusters = clusters});
      all->use([](System& system, Constraints& constraints) {
        return make_integrator("pbd", system, constraints, make_linear_solver("mpcg"));
      });
      return all;
    };
    const auto with = assembly(true, Y), without = assembly(false, Y);
    VecX folded = with->state.x;
    for (int i = 0; i < with->state.particles(); ++i)
      if (const double s = folded[3 * i]; s > 0) folded[3 * i] = 0.6 * s, folded[3 * i + 1] = 0.8 * s;
    CHECK(with->system->elastic_energy(folded) > 1e-6);
    CHECK(with->system->elastic_energy(folded) ==
          Approx(without->system->elastic_energy(folded)).epsilon(1e-9));
    CHECK(with->system->elastic_energy(0.9 * with->state.x) ==
          Approx(Y * 0.01 * area(flat(7, Kind::squares)) +
                 (model == ClothModel::noh_jung ? without->system->elastic_energy(0.9 * with->state.x) : 0))
              .epsilon(1e-6));
    CHECK_THROWS_WITH(with->use("implicit-euler", "mpcg"),
                      Catch::Contains("'clusters' has no stiffness") && Catch::Contains("take \"pbd\""));
  }
}

TEST_CASE("cloth that cannot be of clusters is refused", "[clusters]") {
  const auto add = [](ClothModel model, const Fabric& fabric) {
    Assembly all;
    all.add(ClothPart{
        .name = "sheet", .mesh = flat(5, Kind::squares), .fabric = fabric, .model = model, .clusters = true});
  };
  CHECK_THROWS_WITH(add(ClothModel::choi_ko, {}), Catch::Contains("sheet") && Catch::Contains("noh-jung"));
  CHECK_THROWS_WITH(add(ClothModel::noh_jung, {.stretch_spring = 100.0}), Catch::Contains("stretch_spring"));
  CHECK_THROWS_WITH(add(ClothModel::noh_jung, {.neighbour_weighting = true}),
                    Catch::Contains("neighbour_weighting"));
}

TEST_CASE("a sheet of clusters has the same bits on any number of threads", "[clusters][pbd]") {
  check_same_bits([] {
    Sheets sheet(grid(70, 70, 1, 1), 0.001, 9.81);
    sheet.constraints.pin(0);
    sheet.state.v = random_vector(sheet.state.x.size(), 0.1, 2);
    REQUIRE(sheet.step(3, 2, 0.01).done);
    return sheet.state;
  });
}
