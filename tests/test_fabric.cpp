// From a fabric's numbers to connections: the continuum comes out right, whatever the mesh.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/triangles/topology.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/tension_spring.h"
#include "solver/integrators/integrator.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

double total_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  return area;
}

// Rows of the sheet (z constant) folded one after the other about an axis along x: a polyline on a cylinder,
// no edge changes length.
VecX rolled(const TriangleMesh& mesh, double fold) {
  VecX x = stacked(mesh.positions);
  Vec3 at = mesh.positions.front();
  double row = at.z(), slope = 0;
  for (Eigen::Index i = 0; i < x.size() / 3; ++i) {
    const double z = mesh.positions[i].z();
    if (z > row + 1e-9) {
      at += (z - row) * Vec3(0, std::sin(slope), std::cos(slope));
      slope += fold;
      row = z;
    }
    x[3 * i + 1] = at.y();
    x[3 * i + 2] = at.z();
  }
  return x;
}

}  // namespace

TEST_CASE("the springs of a lattice have the constants of the continuum", "[fabric]") {
  const TriangleMesh mesh = equilateral_sheet(9, 9, 0.1);
  const auto forces = noh_jung(mesh, {.stretch = 800, .bend = 2e-5});
  for (const auto& force : forces) {
    if (const auto* stretch = dynamic_cast<const PairForce<TensionSpring>*>(force.get())) {
      double stiffest = 0;
      for (const auto& e : stretch->elements()) stiffest = std::max(stiffest, e.rest.k);
      CHECK(stiffest == Approx(std::sqrt(3) / 2 * 800));  // interior edges; boundary ones have half
    }
    if (const auto* bend = dynamic_cast<const PairForce<BucklingSpring>*>(force.get()))
      for (const auto& e : bend->elements()) CHECK(e.rest.k_b == Approx(2.0 / 3 * 2e-5 * 0.1));
  }
}

TEST_CASE("stretching a sheet stores Y eps^2 / 2 per area in every direction", "[fabric]") {
  const TriangleMesh mesh = equilateral_sheet(41, 41, 0.025);
  System system(lumped_mass(mesh, 0.1));
  system.add(noh_jung(mesh, {.stretch = 800, .bend = 0}));
  const double eps = 1e-4, area = total_area(mesh);
  for (double angle : {0.0, 0.4, M_PI / 6, M_PI / 2}) {
    // Both principal strains positive, so that no edge goes slack:
    // E = C11/2 (e1^2 + e2^2) + C12 e1 e2, nu = 1/3.
    VecX x = stacked(mesh.positions);
    const Vec3 a(std::cos(angle), 0, std::sin(angle)), b(-std::sin(angle), 0, std::cos(angle));
    for (Eigen::Index i = 0; i < x.size() / 3; ++i) {
      const Vec3 p = x.segment<3>(3 * i);
      x.segment<3>(3 * i) += eps * a.dot(p) * a + 0.5 * eps * b.dot(p) * b;
    }
    const double C11 = 800 / (1 - 1.0 / 9), C12 = C11 / 3;
    const double density = 0.5 * C11 * (eps * eps + 0.25 * eps * eps) + C12 * 0.5 * eps * eps;
    CHECK(system.elastic_energy(x) / area == Approx(density).epsilon(2e-3));
  }
}

TEST_CASE("rolling a sheet stores B kappa^2 / 2 per area, on coarse and fine meshes", "[fabric]") {
  const double B = 2e-5, radius = 0.1;
  for (double edge : {0.02, 0.01, 0.005}) {
    const TriangleMesh mesh =
        equilateral_sheet(static_cast<int>(0.4 / edge) + 1, static_cast<int>(0.4 / edge) + 1, edge);
    const double spacing = edge * std::sqrt(3) / 2;
    System system(lumped_mass(mesh, 0.1));
    system.add(noh_jung(mesh, {.stretch = 500, .bend = B, .buckling_clamp = 1e7}));
    const double density = system.elastic_energy(rolled(mesh, spacing / radius)) / total_area(mesh);
    // The first and the last row have no hinge, so a sheet of n rows misses 1/n of the energy or so.
    INFO("edge " << edge << " m");
    CHECK(density == Approx(B / (2 * radius * radius)).epsilon(1.5 * spacing / 0.35 + 0.01));
  }
}

namespace {
double limp(const TriangleMesh& mesh, const Fabric& fabric) {
  return limp_below(noh_jung_connections(mesh, mesh, fabric), fabric);
}
}  // namespace

TEST_CASE("the default clamp leaves a fabric its rigidity on any mesh, Choi & Ko's c_b = k_s does not",
          "[fabric]") {
  for (double edge : {0.04, 0.01, 0.006}) {
    const TriangleMesh mesh = equilateral_sheet(12, 12, edge);
    CHECK(limp(mesh, {.stretch = 500, .bend = 1e-5}) <= limp_curvature(1e-5, 0.15) * (1 + 1e-9));
  }
  const TriangleMesh fine = equilateral_sheet(12, 12, 0.0025);
  CHECK(limp(fine, {.stretch = 500, .bend = 1e-5, .buckling_clamp = 500}) > 5 * limp_curvature(1e-5, 0.15));
  // Finer still, the default stops at stiffest_clamp: limper than it should be,
  // but less so, and it can be told.
  CHECK(limp(fine, {.stretch = 500, .bend = 1e-5}) > 2 * limp_curvature(1e-5, 0.15));
  CHECK(limp(fine, {.stretch = 500, .bend = 1e-5}) <
        limp(fine, {.stretch = 500, .bend = 1e-5, .buckling_clamp = 500}) / 3);
  // The curvature it names is where the clamp lets go.
  const TriangleMesh mesh = equilateral_sheet(12, 12, 0.01);
  const Fabric fabric{.stretch = 500, .bend = 1e-5, .buckling_clamp = 400};
  const double kappa = limp(mesh, fabric);
  CHECK(kappa == Approx(std::sqrt(8 * 1e-5 * 1.5 / (400 * std::pow(0.01, 4)))).epsilon(0.5));
}

TEST_CASE("with neighbour weights the momentum of the lighter masses is kept, that of the cloth's is not",
          "[fabric]") {
  const TriangleMesh mesh = grid(6, 6, 1, 1);
  const Fabric fabric{.area_density = 0.2, .stretch = 20, .neighbour_weighting = true};
  const std::vector<double> plain = lumped_mass(mesh, 0.2), weighted = masses(mesh, fabric);
  System system(weighted);
  system.add(noh_jung(mesh, fabric));
  Constraints constraints;
  const auto stepper = make_integrator("implicit-euler", system, constraints, make_linear_solver("mpcg"),
                                       {.tolerance = 1e-12});
  State state = at_rest(mesh);
  state.x += random_vector(3 * 36, 0.05, 3);
  for (int n = 0; n < 5; ++n) REQUIRE(stepper->advance(state, 0.01).done);
  Vec3 of_lighter = Vec3::Zero(), of_cloth = Vec3::Zero();
  double moving = 0;
  for (int i = 0; i < 36; ++i) {
    const auto k = static_cast<std::size_t>(i);
    of_lighter += weighted[k] * state.v.segment<3>(3 * i);
    of_cloth += plain[k] * state.v.segment<3>(3 * i);
    moving += plain[k] * state.v.segment<3>(3 * i).norm();
  }
  CHECK(of_lighter.norm() < 1e-9 * moving);
  CHECK(of_cloth.norm() > 1e-3 * moving);
}

TEST_CASE("neighbour weighting is masses, so momentum and symmetry survive it", "[fabric]") {
  const TriangleMesh mesh = grid(6, 6, 1, 1);
  const std::vector<double> plain = lumped_mass(mesh, 0.2),
                            weighted = masses(mesh, {.area_density = 0.2, .neighbour_weighting = true});
  double lightest = 1e9, heaviest = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    lightest = std::min(lightest, weighted[i] / plain[i]);
    heaviest = std::max(heaviest, weighted[i] / plain[i]);
  }
  CHECK(heaviest == Approx(1));  // the best connected vertex keeps its mass
  CHECK(lightest < 0.5);         // a corner is pulled w times as hard: it weighs 1/w
  System system(weighted);
  system.add(noh_jung(mesh, {}));
  const auto pattern = system.bind();
  BlockMatrix A(pattern);
  A.set_to_mass(weighted);
  // A - M is c^2 K, and K is what the right-hand side sees: b(y) = c (f - K y).
  constexpr double c = 0.01;
  const VecX none = VecX::Zero(3 * 36), y = random_vector(3 * 36, 0.01, 2);
  const VecX x = stacked(mesh.positions) + random_vector(3 * 36, 0.03, 1);
  VecX b_without = none, b_with = none, y_rows = none, product = none, Ky = none;
  for (const auto& force : system.forces()) {
    force->add_linearised(x, none, none, c, Stiffness::tangent, A, b_without);
    BlockMatrix scratch(pattern);
    force->add_linearised(x, none, y, c, Stiffness::tangent, scratch, b_with);
  }
  to_rows(*pattern, y, y_rows);
  A.multiply(y_rows, product);
  to_particles(*pattern, product, Ky);
  for (int i = 0; i < 36; ++i) Ky.segment<3>(3 * i) -= weighted[i] * y.segment<3>(3 * i);
  CHECK((Ky + c * (b_with - b_without)).norm() <= 1e-12 * Ky.norm());
}

TEST_CASE("a mesh at rest is in equilibrium, flat or curved", "[fabric]") {
  for (const TriangleMesh& mesh : {grid(9, 7, 1, 1), disc(5, 0.4), tube(16, 6, 0.2, 0.5), sphere(2, 0.3)}) {
    System system(lumped_mass(mesh, 0.2));
    system.add(noh_jung(mesh, {.damping = 0.01}));
    const VecX x = stacked(mesh.positions);
    CHECK(system.force(x, VecX::Zero(x.size())).norm() < 1e-9);
    CHECK(system.elastic_energy(x) < 1e-15);
  }
}

TEST_CASE("masses: a third of every triangle, nothing lost, isolated vertices none", "[fabric]") {
  TriangleMesh mesh = disc(6, 0.5);
  mesh.positions.push_back({9, 9, 9});
  double sum = 0;
  const auto mass = lumped_mass(mesh, 0.3);
  for (double m : mass) sum += m;
  CHECK(sum == Approx(0.3 * total_area(mesh)));
  CHECK(mass.back() == 0);
}

TEST_CASE("degenerate triangles give finite springs", "[fabric]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.5, 0, 0}};
  mesh.triangles = {
      {0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {0, 1, 2}};  // a seam of no width, a collinear one, a double
  System system(lumped_mass(mesh, 0.2));
  for (double m : system.masses()) CHECK(m > 0);
  system.add(noh_jung(mesh, {}));
  const VecX x = stacked(mesh.positions) + random_vector(15, 0.1, 2);
  CHECK(system.force(x, VecX::Zero(15)).allFinite());
  CHECK(std::isfinite(system.elastic_energy(x)));
}

TEST_CASE("a fabric that makes no sense is refused by name", "[fabric]") {
  const TriangleMesh mesh = grid(3, 3, 1, 1);
  CHECK_THROWS_WITH(noh_jung(mesh, {.area_density = -1}), Catch::Contains("area_density"));
  CHECK_THROWS_WITH(noh_jung(mesh, {.stretch = -1}), Catch::Contains("stretch"));
  CHECK_THROWS_WITH(noh_jung(mesh, {.bend = std::nan("")}), Catch::Contains("bend"));
  CHECK_THROWS_WITH(noh_jung(mesh, {.damping = -2}), Catch::Contains("damping"));
  CHECK_THROWS_AS(System({1.0, -1.0}), InputError);
}
