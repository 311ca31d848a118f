// The woven fabric against closed forms: constant strain, constant curvature and the cantilever, on meshes of
// every kind, in several directions and at several sizes.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <set>

#include "mesh/base/errors.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/woven.h"
#include "tests/bent_wave.h"
#include "tests/strips.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double density = 0.15, Y = 500, B = 1e-5;

Fabric plain() { return {.area_density = density, .stretch = Y, .bend = B}; }

Fabric directed() {
  Fabric fabric = plain();
  fabric.weave = {.stretch_weft = 300, .shear = 40, .poisson = 0.2, .bend_weft = 4e-6, .bend_bias = 5e-6};
  return fabric;
}

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  return area;
}

// The positions x(X) of a sheet in the plane y = 0; the function gets (X.x, X.z).
template <class F>
VecX moved(const TriangleMesh& mesh, const F& f) {
  std::vector<Vec3> all;
  for (const Vec3& x : mesh.positions) all.push_back(f(x.x(), x.z()));
  return stacked(all);
}

// Vertices that are at least `away` edges from the border.
std::vector<int> inner_vertices(const TriangleMesh& mesh, int away) {
  std::set<int> outer;
  for (const Edge& e : edges(mesh))
    if (e.triangles == 1) outer.insert({e.a, e.b});
  for (int ring = 1; ring < away; ++ring) {
    std::set<int> more = outer;
    for (const Edge& e : edges(mesh)) {
      if (outer.contains(e.a)) more.insert(e.b);
      if (outer.contains(e.b)) more.insert(e.a);
    }
    outer = more;
  }
  std::vector<int> inner;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (!outer.contains(i)) inner.push_back(i);
  return inner;
}

std::unique_ptr<Force> force_of(const TriangleMesh& mesh, const Fabric& fabric, const Vec3& warp,
                                std::string_view name) {
  for (std::unique_ptr<Force>& force : woven(mesh, mesh, fabric, warp))
    if (force->name() == name) return std::move(force);
  FAIL("there is no force " << name);
  return {};
}

VecX pushed(const Force& force, const VecX& x) {
  VecX f = VecX::Zero(x.size());
  force.add_force(x, VecX::Zero(x.size()), f);
  return f;
}

}  // namespace

TEST_CASE("a membrane has the moduli it was given, on every mesh, whatever the direction of the strain",
          "[woven]") {
  const double tiny = 1e-6;
  for (StripMesh kind : strip_meshes)
    for (int cells : {4, 8, 16}) {
      const TriangleMesh mesh = strip(kind, cells, cells, 0.4).mesh;
      const double area = area_of(mesh);
      for (double angle : {0.0, 0.3, M_PI / 4, 1.2}) {
        INFO(name(kind) << ", " << cells << " cells, strain at " << angle << " rad");
        const Eigen::Rotation2Dd turn(angle);
        const Vec3 warp(std::cos(angle), 0, std::sin(angle));
        // The strain is given in the axes of the warp, which turn with the angle.
        const auto energy = [&](const Fabric& fabric, double warpwise, double weftwise, double shear) {
          Eigen::Matrix2d strain;
          strain << warpwise, shear / 2, shear / 2, weftwise;
          const Eigen::Matrix2d F =
              Eigen::Matrix2d::Identity() + tiny * (turn * strain * turn.inverse()).eval();
          const VecX x = moved(mesh, [&](double a, double b) {
            const Eigen::Vector2d at = F * Eigen::Vector2d(a, b);
            return Vec3(at[0], 0.2, at[1]);
          });
          const auto force = force_of(mesh, fabric, warp, "membrane");
          const VecX f = pushed(*force, x);
          double net = 0;  // nothing pulls inside where the strain is constant
          for (int i : inner_vertices(mesh, 1)) net = std::max(net, f.segment<3>(3 * i).norm());
          CHECK(net < 1e-6 * f.lpNorm<Eigen::Infinity>());
          return 2 * force->energy(x) / (area * tiny * tiny);
        };
        const double nu = plain().weave.poisson, mean = std::sqrt(500.0 * 300.0);
        // Pulled along the warp, free across it: narrower by nu.
        CHECK(energy(plain(), 1, -nu, 0) == Approx(Y).epsilon(2e-6));
        CHECK(energy(plain(), 0, 0, 1) == Approx(Y / (2 * (1 + nu))).epsilon(2e-6));
        CHECK(energy(directed(), 1, -0.2 * std::sqrt(500.0 / 300), 0) == Approx(500).epsilon(2e-6));
        CHECK(energy(directed(), -0.2 * std::sqrt(300.0 / 500), 1, 0) == Approx(300).epsilon(2e-6));
        CHECK(energy(directed(), 0, 0, 1) == Approx(40).epsilon(2e-6));
        CHECK(energy(directed(), 1, 1, 0) == Approx((500 + 300 + 0.4 * mean) / (1 - 0.04)).epsilon(2e-6));
      }
    }
}

TEST_CASE("a share of compression is a share of the energy where no thread is taut, and of no taut one",
          "[woven]") {
  const TriangleMesh mesh = strip(StripMesh::irregular, 6, 6, 0.3).mesh;
  const auto energy = [&](double share, double warpwise, double weftwise) {
    Fabric fabric = plain();
    fabric.weave.compression = share;
    return force_of(mesh, fabric, Vec3::UnitX(), "membrane")->energy(moved(mesh, [&](double a, double b) {
      return Vec3((1 + warpwise) * a, 0, (1 + weftwise) * b);
    }));
  };
  const double area = area_of(mesh);
  for (double share : {0.0, 0.2, 1.0}) {
    INFO("share " << share);
    CHECK(energy(share, -0.02, -0.03) == Approx(share * energy(1, -0.02, -0.03)).margin(1e-15));
    CHECK(energy(share, 0.02, 0.03) == Approx(energy(1, 0.02, 0.03)));
    // Narrower than a free strip: the weft has wrinkled, the warp pulls as it does in a tensile test.
    const double taut = 0.5 * Y * 0.02 * 0.02 * area;
    CHECK(energy(share, 0.02, -0.1) == Approx(share * energy(1, 0.02, -0.1) + (1 - share) * taut));
  }
}

TEST_CASE("constant curvature of a plate is in equilibrium on every mesh and in every direction", "[woven]") {
  for (StripMesh kind : strip_meshes)
    for (int cells : {10, 13, 16}) {
      const TriangleMesh mesh = strip(kind, cells, cells, 0.4).mesh;
      for (const Fabric& fabric : {plain(), directed()}) {
        const auto plate = force_of(mesh, fabric, Vec3(0.8, 0, 0.6), "bend");
        const auto push_of = [&](const auto& height) {
          return pushed(*plate, moved(mesh, [&](double a, double b) { return Vec3(a, height(a, b), b); }));
        };
        const std::vector<int> inner = inner_vertices(mesh, 3);
        REQUIRE(inner.size() > 10);
        const auto scale = push_of([](double a, double) { return 1e-3 * a * a * a; }).cwiseAbs().mean();
        for (double angle : {0.0, 0.4, M_PI / 4, 1.1, M_PI / 2}) {
          INFO(name(kind) << ", " << cells << " cells, bent along " << angle << " rad");
          const VecX f = push_of([&](double a, double b) {
            const double along = std::cos(angle) * a + std::sin(angle) * b;
            return along * along;
          });
          for (int i : inner) CHECK(f.segment<3>(3 * i).norm() < 1e-6 * scale);
        }
      }
    }
}

TEST_CASE(
    "a plate bends with the energy of its curvature in every direction, and nothing but a plane is free",
    "[woven]") {
  // The error falls with the square of the mesh size. The stiffness is written out: a strip on the bias that
  // does not curve across has the rigidity (warp + weft + 2 cross) / 4 + twist.
  const Fabric fabric = directed();
  const Weave& weave = fabric.weave;
  const double cross = weave.bend_poisson * std::sqrt(B * *weave.bend_weft);
  const PlateStiffness D{B, *weave.bend_weft, cross,
                         *weave.bend_bias - (B + *weave.bend_weft + 2 * cross) / 4};
  const Vec3 warp(std::cos(0.2), 0, std::sin(0.2));
  for (StripMesh kind : strip_meshes)
    for (double angle : {0.0, 0.5, M_PI / 4}) {
      std::vector<double> error;
      for (int cells : {20, 40}) {
        const TriangleMesh mesh = wave_sheet(kind, cells);
        error.push_back(
            std::abs(wave_energy_error(mesh, *force_of(mesh, fabric, warp, "bend"), D, warp, angle, 0.2)));
      }
      INFO(name(kind) << ", along " << angle << " rad: " << error[0] << " " << error[1]);
      CHECK(error[1] < 0.07);
      CHECK(error[1] < 0.4 * error[0]);
    }

  for (StripMesh kind : strip_meshes) {
    const TriangleMesh mesh = strip(kind, 6, 4, 0.3).mesh;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(mesh.vertex_count(), mesh.vertex_count());
    for (const PlatePair& p : plate_energy(mesh, woven_corners(mesh, {}), plate_of(plain())).pairs)
      K(p.i, p.i) += p.k, K(p.j, p.j) += p.k, K(p.i, p.j) -= p.k, K(p.j, p.i) -= p.k;
    const Eigen::VectorXd e = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    INFO(name(kind) << ": " << e.head(5).transpose() << " .. " << e[e.size() - 1]);
    CHECK(std::abs(e[0]) < 1e-12 * e[e.size() - 1]);
    CHECK(std::abs(e[2]) < 1e-12 * e[e.size() - 1]);
    CHECK(e[3] > 1e-6 * e[e.size() - 1]);
  }
}

TEST_CASE("a plate with slivers has no negative stiffness", "[woven]") {
  for (double height : {1e-2, 1e-3, 2e-4, 1e-5}) {
    TriangleMesh mesh = grid(5, 5, 0.1, 0.1);
    mesh.positions[12] = mesh.positions[7] + 0.37 * (mesh.positions[11] - mesh.positions[7]) +
                         Vec3(0, 0, height * 0.025);  // nearly on an edge across from it
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(mesh.vertex_count(), mesh.vertex_count());
    for (const PlatePair& p : plate_energy(mesh, woven_corners(mesh, {}), plate_of(plain())).pairs)
      K(p.i, p.i) += p.k, K(p.j, p.j) += p.k, K(p.i, p.j) -= p.k, K(p.j, p.i) -= p.k;
    const Eigen::VectorXd e = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    INFO("height " << height << ": " << e[0] << " .. " << e[e.size() - 1]);
    CHECK(e[0] > -1e-12 * e[e.size() - 1]);
  }
}

TEST_CASE("a woven cantilever comes to the elastica on every mesh, to second order", "[woven][reference]") {
  const auto droop = [](StripMesh kind, int cells, double gamma) {
    const Strip s = strip(kind, cells, cells < 40 ? 4 : 8, std::cbrt(gamma * B / (density * 9.81)));
    System system(masses(s.mesh, plain()));
    system.add(woven(s.mesh, s.mesh, plain()));
    system.add(Gravity{});
    Constraints constraints;
    constraints.pin(s.clamped);
    ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg+block-ic0"), {.tolerance = 1e-10});
    State state = at_rest(s.mesh);
    const double h = 0.1 * std::sqrt(s.length);
    for (int step = 0; step < 2000; ++step) {
      REQUIRE(stepper.advance(state, h).done);
      if (max_speed(state) < 1e-8) break;
    }
    double H = 0, W = 0;
    for (int i : s.tip) {
      H -= state.x[3 * i + 1];
      W += state.x[3 * i];
    }
    return H / W;
  };
  const auto expected = [](double gamma) {
    for (const auto& row : reference_table("cantilever_master.csv"))
      if (std::abs(row[0] / gamma - 1) < 1e-6) return row[1];
    FAIL("no row of the reference has this gamma");
    return 0.0;
  };
  for (StripMesh kind : strip_meshes) {
    for (double gamma : {0.01, 1.0, 10.0}) {
      INFO(name(kind) << ", gamma " << gamma);
      CHECK(droop(kind, 20, gamma) == Approx(expected(gamma)).epsilon(0.01));
    }
    const double coarse = std::abs(droop(kind, 10, 1) / expected(1) - 1),
                 fine = std::abs(droop(kind, 40, 1) / expected(1) - 1);
    INFO(name(kind) << ", error at 10 and 40 cells: " << coarse << " " << fine);
    CHECK(std::log2(coarse / fine) / 2 > 1.5);
  }
}

TEST_CASE("a woven sheet that swings makes no energy", "[woven]") {
  const TriangleMesh mesh = equilateral_sheet(13, 13, 0.05);
  System system(masses(mesh, plain()));
  Fabric fabric = directed();
  fabric.weave.compression = 0.1;
  system.add(woven(mesh, mesh, fabric, Vec3(1, 0, 1)));
  system.add(Gravity{});
  Constraints constraints;
  constraints.pin({0, 12});
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg+block-ic0"), {.tolerance = 1e-8});
  State state = at_rest(mesh);
  double before = system.total_energy(state);
  const double scale = std::abs(system.gravity_energy(state.x)) + 1;
  for (int step = 0; step < 200; ++step) {
    REQUIRE(stepper.advance(state, 0.01).done);
    const double after = system.total_energy(state);
    CHECK(after <= before + 1e-9 * scale);
    before = after;
  }
}

TEST_CASE("a woven cloth that is cut and laid elsewhere in its rest shape is the same cloth", "[woven]") {
  const TriangleMesh mesh = strip(StripMesh::irregular, 6, 4, 0.3).mesh;
  TriangleMesh apart;  // every triangle by itself, turned and moved in the plane
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::AngleAxisd turn(0.7 * static_cast<double>(t), Vec3::UnitY());
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = apart.vertex_count();
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][k]);
      apart.positions.push_back(turn * mesh.positions[vertex] + Vec3(static_cast<double>(t), 0, 0));
    }
    apart.triangles.push_back(corners);
  }
  const VecX x = moved(mesh, [](double a, double b) { return Vec3(1.01 * a, a * b, b + 0.2 * a); });
  const auto whole = woven(mesh, mesh, plain()), cut = woven(mesh, apart, plain());
  REQUIRE(whole.size() == cut.size());
  for (std::size_t k = 0; k < whole.size(); ++k) CHECK(cut[k]->energy(x) == Approx(whole[k]->energy(x)));
}

TEST_CASE("numbers that make no woven law are refused by name", "[woven]") {
  const TriangleMesh mesh = grid(3, 3, 1, 1);
  const auto refused = [&](const auto& spoil) {
    Fabric fabric = directed();
    spoil(fabric);
    try {
      woven(mesh, mesh, fabric, Vec3::UnitX());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using Catch::Matchers::Contains;
  CHECK(refused([](Fabric&) {}).empty());
  CHECK_THAT(refused([](Fabric& f) { f.weave.poisson = 1; }), Contains("poisson = 1: "));
  CHECK_THAT(refused([](Fabric& f) { f.weave.bend_poisson = -1.5; }), Contains("bend_poisson = -1.5"));
  CHECK_THAT(refused([](Fabric& f) { f.weave.shear = 0; }), Contains("shear = 0 N/m"));
  CHECK_THAT(refused([](Fabric& f) { f.weave.stretch_weft = -3; }), Contains("stretch_weft = -3 N/m"));
  CHECK_THAT(refused([](Fabric& f) { f.weave.bend_bias = 1e-7; }),
             Contains("bend_bias = 1e-07 N.m") && Contains("greater than 3.5e-06 N.m"));
  CHECK_THAT(refused([](Fabric& f) { f.weave.compression = 1.1; }), Contains("compression = 1.1"));
  CHECK_THAT(refused([](Fabric& f) { f.weave.bend_time = -1; }), Contains("bend_time = -1 s"));
  CHECK_THAT(refused([](Fabric& f) { f.stretch = 0; }), Contains("stretch = 0 N/m"));
  CHECK_THAT(refused([](Fabric& f) { f.buckling_clamp = 3; }), Contains("buckling_clamp"));
  CHECK_THROWS_WITH(woven(mesh, mesh, directed()), Contains("direction"));
  CHECK_THROWS_WITH(woven(mesh, mesh, directed(), Vec3::Zero()), Contains("[0, 0, 0]"));
  CHECK_THROWS_WITH(woven(mesh, mesh, directed(), Vec3(NAN, 1, 0)), Contains("finite"));
  CHECK_THROWS_WITH(woven(mesh, grid(3, 4, 1, 1), plain()), Contains("12 triangles"));
  Fabric wrinkling = plain();
  wrinkling.weave.compression = 0.5;  // along the threads, which have to be somewhere
  CHECK_THROWS_WITH(woven(mesh, mesh, wrinkling), Contains("direction"));
  CHECK(woven(mesh, mesh, plain()).size() == 2);
  CHECK_THROWS_WITH(woven(mesh, mesh, directed(), Vec3::UnitY()),
                    Contains("triangle 1, at (") && Contains("is square to the warp"));
}
