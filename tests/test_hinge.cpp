// Bending by hinges: what a mesh of them resists, against closed forms.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "solver/forces/hinge.h"
#include "solver/forces/plate_force.h"
#include "solver/forces/woven.h"
#include "solver/system/system.h"
#include "tests/dense.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::internal;
using namespace drape::test;

namespace {

constexpr PlateStiffness isotropic{1, 1, 0, 0.5};

// n x n cells with the sides a and b, each of two triangles.
TriangleMesh lattice(int n, const Vec3& a, const Vec3& b) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) mesh.positions.push_back(i * a + j * b);
  const auto at = [&](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

std::unique_ptr<Force> bending(const TriangleMesh& mesh, const PlateStiffness& D, Bending kind,
                               double rest_angle = 0) {
  const std::vector<Vec3> warp(mesh.triangles.size(), Vec3::UnitX());
  const auto corners = woven_corners(mesh, warp);
  if (kind == Bending::hinges) return hinge_force(mesh, corners, D, rest_angle, 0);
  return std::make_unique<PlateForce>(quadratic_hinges(mesh, corners, D), 0);
}

// Two triangles, the second folded by the angle about their edge, which runs along x.
VecX folded(double angle) {
  VecX x(12);
  x << 0, 0, 0, 1, 0, 0, 0.4, 0, -1, 0.5, std::sin(angle), std::cos(angle);
  return x;
}

TriangleMesh two_triangles(const VecX& x) {
  TriangleMesh mesh;
  for (int v = 0; v < 4; ++v) mesh.positions.push_back(x.segment<3>(3 * v));
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  return mesh;
}

}  // namespace

TEST_CASE("lattices of hinges are the plates that theory says", "[woven][reference]") {
  // The energy of a cell under a small constant curvature. The diagonals of the squares run down, along (1,
  // -1).
  struct Lattice {
    const char* name;
    Vec3 b;
    double D11, D22, D12, D66, D16, D26;
  };
  for (const Lattice& L :
       {Lattice{"equilateral", Vec3(0.5, 0, std::sqrt(0.75)), 1, 1, -1.0 / 3, 2.0 / 3, 0, 0},
        Lattice{"squares", Vec3::UnitZ(), 1, 1, 0, 1.5, -0.5, -0.5}})
    for (Bending kind : {Bending::hinges, Bending::quadratic_hinges})
      for (const Vec3& K :
           {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(0.7, -0.4, 0.5)}) {
        INFO(L.name << ", curvature " << K.transpose());
        // So small that angles and slopes are the same; the second difference leaves out the border.
        const double small = 1e-4;
        const auto energy = [&](int n) {
          const TriangleMesh mesh = lattice(n, Vec3::UnitX(), L.b);
          VecX x = stacked(mesh.positions);
          for (int v = 0; v < mesh.vertex_count(); ++v) {
            const double a = x[3 * v], b = x[3 * v + 2];
            x[3 * v + 1] = small * (0.5 * K[0] * a * a + 0.5 * K[1] * b * b + K[2] * a * b);
          }
          return bending(mesh, isotropic, kind)->energy(x) / (small * small);
        };
        const double of_cell = 0.5 * (energy(6) - 2 * energy(5) + energy(4)) / L.b.z();
        const double expected = 0.5 * (L.D11 * K[0] * K[0] + L.D22 * K[1] * K[1] + 2 * L.D12 * K[0] * K[1] +
                                       4 * (L.D66 * K[2] + L.D16 * K[0] + L.D26 * K[1]) * K[2]);
        CHECK(of_cell == Approx(expected).margin(1e-5));
      }
}

TEST_CASE(
    "the energy of a hinge is 1/2 B l^2 / (A_c + A_d) of the square of its angle, the shorter way round",
    "[woven]") {
  // A_c + A_d = 1 m^2, l = 1 m.
  const double pi = 3.14159265358979323846;
  for (double rest : {0.0, 0.6, 2.8, -2.8}) {
    const TriangleMesh mesh = two_triangles(folded(rest));
    const auto hinge = bending(mesh, isotropic, Bending::hinges, 1);
    for (double angle : {-3.1, -1.5, 0.0, 0.01, 0.6, 2.8, 3.1}) {
      const double d = std::min(std::abs(angle - rest), 2 * pi - std::abs(angle - rest));
      CHECK(hinge->energy(folded(angle)) == Approx(0.5 * d * d).margin(1e-12));
    }
  }
  const auto quadratic = bending(two_triangles(folded(0)), isotropic, Bending::quadratic_hinges);
  for (double angle : {0.01, 1.0, 3.0})
    CHECK(quadratic->energy(folded(angle)) == Approx(2 * std::pow(std::sin(angle / 2), 2)));
}

TEST_CASE("a hinge takes the rigidity across its edge", "[woven]") {
  const PlateStiffness D{5, 1, 0.4, 0.7};
  for (double turn : {0.0, 0.5, 1.0, 1.57}) {
    const Eigen::AngleAxisd rotation(turn, Vec3::UnitY());
    const auto turned = [&](double angle) {
      VecX x = folded(angle);
      for (int v = 0; v < 4; ++v) x.segment<3>(3 * v) = rotation * Vec3(x.segment<3>(3 * v));
      return x;
    };
    const Vec3 across = rotation * Vec3::UnitZ();
    const double u = across.x() * across.x(), v = across.z() * across.z();
    const double B = 5 * u * u + v * v + (2 * 0.4 + 4 * 0.7) * u * v;
    CHECK(bending(two_triangles(turned(0)), D, Bending::hinges)->energy(turned(0.3)) ==
          Approx(0.5 * 0.3 * 0.3 * B));
    CHECK(bending(two_triangles(turned(0)), D, Bending::quadratic_hinges)->energy(turned(0.3)) ==
          Approx(2 * B * std::pow(std::sin(0.15), 2)));
  }
}

TEST_CASE("the force of a hinge stays bounded where a triangle is squeezed to nothing", "[woven]") {
  const auto hinge = bending(two_triangles(folded(0)), isotropic, Bending::hinges);
  for (double height : {1.0, 1e-2, 1e-6, 0.0}) {
    VecX x = folded(0.5), f = VecX::Zero(12);
    x[8] *= height;
    hinge->add_force(x, VecX::Zero(12), f);
    INFO(height << ": " << f.transpose());
    CHECK(f.allFinite());
    CHECK(f.norm() < 1e3);
  }
}

TEST_CASE("the matrix of hinges is that of their force where they rest, and nowhere indefinite",
          "[woven][forces]") {
  const double T = 0.02, c = 0.1;
  for (double rest : {0.0, 0.7}) {
    const TriangleMesh mesh = two_triangles(folded(rest));
    Fabric fabric{.stretch = 0, .bend = 1};
    fabric.weave.bending = Bending::hinges;
    fabric.weave.rest_angle = 1;
    fabric.weave.bend_time = T;
    System system(std::vector<double>(4, 1.0));
    system.add(woven(mesh, mesh, fabric));
    REQUIRE(system.forces().size() == 1);
    const Force& hinge = *system.forces()[0];
    const VecX still = VecX::Zero(12), at_rest = stacked(mesh.positions);
    const auto force = [&](const VecX& x, const VecX& v) {
      VecX f = still;
      hinge.add_force(x, v, f);
      return f;
    };
    for (const VecX& x : {at_rest, VecX(at_rest + random_vector(12, 0.2, 5))}) {
      const VecX v = random_vector(12, 1, 4), y = random_vector(12, 0.01, 6);
      BlockMatrix A = system.matrix();
      A.set_to_mass(std::vector<double>(4, 0.0));
      VecX b = still;
      hinge.add_linearised(x, v, y, c, Stiffness::tangent, A, b);
      const Eigen::MatrixXd K = dense(A) / (c * (c + T));
      CHECK((K - K.transpose()).norm() <= 1e-15 * K.norm());
      CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff() > -1e-13 * K.norm());
      CHECK((b - c * (force(x, v) - K * y)).norm() < 1e-12 * (1 + b.norm()));
      CHECK((force(x, v) - force(x, still) + T * K * v).norm() < 1e-12 * (1 + (K * v).norm()));
      CHECK(hinge.dissipation(x, v) == Approx(0.5 * T * v.dot(K * v)));
      if (x != at_rest) continue;
      Eigen::MatrixXd slope(12, 12);
      const double d = 1e-6;
      for (Eigen::Index k = 0; k < 12; ++k) {
        const VecX way = d * VecX::Unit(12, k);
        slope.col(k) = (force(x - way, still) - force(x + way, still)) / (2 * d);
      }
      CHECK((K - slope).norm() < 1e-6 * K.norm());
    }
  }
}
