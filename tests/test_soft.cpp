// Lattices of particles and the springs between them: counts, moduli, masses, and surfaces that they carry.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numeric>

#include "mesh/base/errors.h"
#include "mesh/lattice/solid.h"
#include "solver/forces/linear_spring.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

VecX affine(const std::vector<Vec3>& points, const Mat3& F, const Vec3& t) {
  VecX x(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    x.segment<3>(3 * static_cast<Eigen::Index>(i)) = F * points[i] + t;
  return x;
}

double energy(const std::vector<std::unique_ptr<Force>>& forces, const VecX& x) {
  double sum = 0;
  for (const auto& force : forces) sum += force->energy(x);
  return sum;
}

Mat3 small_strain(unsigned seed) {
  const VecX r = random_vector(9, 1e-5, seed);
  Mat3 E = Eigen::Map<const Mat3>(r.data());
  return 0.5 * (E + E.transpose());
}

double volume_of(const Lattice& lattice) {
  return std::accumulate(lattice.volumes.begin(), lattice.volumes.end(), 0.0);
}

}  // namespace

TEST_CASE("a cube of 10 x 10 x 10 particles has 2700 structural, 7776 shear and 2400 bend springs",
          "[soft]") {
  const Lattice cube = box_lattice({10, 10, 10}, Vec3::Constant(0.1));
  CHECK(cube.particle_count() == 1000);
  CHECK(cube.structural.size() == 2700);
  CHECK(cube.shear.size() == 7776);
  CHECK(cube.bend.size() == 2400);
  const auto forces = soft_body(cube, {.young = {}, .structural = 1, .shear = 1, .bend = 1, .damping = 1});
  std::vector<ParticlePair> pairs;
  forces.back()->list_pairs(pairs);
  CHECK(pairs.size() == 12876);
  for (const LatticePair& p : cube.structural)
    CHECK((cube.positions[p.i] - cube.positions[p.j]).norm() == Approx(0.1).epsilon(1e-12));
}

TEST_CASE("spring counts of a box: closed forms, each pair once", "[soft]") {
  const std::array<int, 3> n = {4, 2, 5};
  const Lattice box = box_lattice(n, {0.1, 0.2, 0.3});
  const auto of = [&](auto f) { return f(n[0], n[1], n[2]) + f(n[1], n[2], n[0]) + f(n[2], n[0], n[1]); };
  CHECK(static_cast<int>(box.structural.size()) == of([](int a, int b, int c) { return (a - 1) * b * c; }));
  CHECK(static_cast<int>(box.bend.size()) ==
        of([](int a, int b, int c) { return std::max(0, a - 2) * b * c; }));
  CHECK(static_cast<int>(box.shear.size()) ==
        of([](int a, int b, int c) { return 2 * (a - 1) * (b - 1) * c; }) + 4 * 3 * 1 * 4);
  std::vector<std::pair<int, int>> all;
  for (const auto* list : {&box.structural, &box.shear, &box.bend})
    for (const LatticePair& p : *list) {
      CHECK(p.i < p.j);
      all.emplace_back(p.i, p.j);
    }
  std::sort(all.begin(), all.end());
  CHECK(std::adjacent_find(all.begin(), all.end()) == all.end());
}

TEST_CASE("the energy of an affine strain is that of the lattice's moduli", "[soft]") {
  // C_ijkl = 1/V sum k l^2 t_i t_j t_k t_l of an endless lattice, with the cells' own shares.
  const double a = 0.05, young = 12e3, mu = young / 2.5, lambda = mu;  // nu = 1/4
  const Lattice box = box_lattice({5, 4, 7}, Vec3::Constant(a));
  const TriangleMesh ball = drape::sphere(3, 0.3);
  for (const Lattice& lattice : {box, filled_lattice(ball, a, "ball")}) {
    const auto forces = soft_body(lattice, {.young = young});
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Mat3 E = small_strain(seed);
      const double density = 0.5 * lambda * E.trace() * E.trace() + mu * E.squaredNorm();
      CHECK(energy(forces, affine(lattice.positions, Mat3::Identity() + E, Vec3(1, 2, 3))) ==
            Approx(density * volume_of(lattice)).epsilon(1e-3));
    }
  }
}

TEST_CASE("springs of one strength each have the moduli of the affine sum", "[soft]") {
  const double a = 0.1, k_s = 30, k_h = 11, k_b = 7;
  const int n = 24;  // the faces count whole: they are stiffer by a share that falls with n
  const Lattice cube = box_lattice({n, n, n}, Vec3::Constant(a));
  const auto modulus = [&](const Mat3& E) {
    const auto forces = soft_body(cube, {.young = {}, .structural = k_s, .shear = k_h, .bend = k_b});
    return 2 * energy(forces, affine(cube.positions, Mat3::Identity() + E, Vec3::Zero())) / volume_of(cube) /
           E.squaredNorm();
  };
  // Counted out for this box: so many springs of each kind, C = 1/V sum k l^2 t^4.
  const double V = volume_of(cube), s = n - 1.0;
  const double C11 =
      a * a / V *
      (k_s * s * n * n + 4 * k_b * (s - 1) * n * n + k_h * (0.5 * 4 * s * s * n) + k_h / 3 * 4 * s * s * s);
  const double C12 = a * a / V * (k_h * 0.5 * 2 * s * s * n + k_h / 3 * 4 * s * s * s);
  Mat3 stretch = Mat3::Zero(), shear = Mat3::Zero();
  stretch(0, 0) = 1e-6;
  shear(0, 1) = shear(1, 0) = 1e-6;
  CHECK(modulus(stretch) == Approx(C11).epsilon(1e-4));
  CHECK(modulus(shear) == Approx(2 * C12).epsilon(1e-4));                  // Cauchy: C44 = C12
  CHECK(C11 == Approx((k_s + 4 * k_b + 10 * k_h / 3) / a).epsilon(0.12));  // of the endless lattice
  CHECK(C12 == Approx(7 * k_h / 3 / a).epsilon(0.12));
}

TEST_CASE("masses: by the cells round a particle, in equal parts, or all that was asked for", "[soft]") {
  const Lattice cube = box_lattice({3, 3, 3}, Vec3::Constant(0.5));
  const auto sum = [](const std::vector<double>& m) { return std::accumulate(m.begin(), m.end(), 0.0); };
  const auto by_cells = masses(cube, {.density = 100});
  CHECK(sum(by_cells) == Approx(100).epsilon(1e-12));
  CHECK(by_cells[0] == Approx(100.0 / 64).epsilon(1e-12));
  CHECK(by_cells[13] == Approx(100.0 / 8).epsilon(1e-12));  // in the middle
  for (double m : masses(cube, {.mass = 5.4, .equal_masses = true})) CHECK(m == Approx(0.2).epsilon(1e-12));
  CHECK(sum(masses(cube, {.density = 100}, 0.3)) == Approx(30).epsilon(1e-12));
}

TEST_CASE("a filled surface lies in its cells, and a box on the grid takes no cell more", "[soft]") {
  for (const double spacing : {0.31, 0.1, 0.037}) {
    const TriangleMesh ball = drape::sphere(3, 0.3);
    const Lattice lattice = filled_lattice(ball, spacing, "ball");
    CHECK(volume_of(lattice) > solid_of(ball).volume);
    const Embedding held = embedding_in(lattice, ball.positions, 0);
    const std::vector<Vec3> at = held.positions(stacked(lattice.positions));
    for (std::size_t v = 0; v < at.size(); ++v) CHECK((at[v] - ball.positions[v]).norm() < 1e-14);
    // In a cell: no weight beyond 0 and 1, so that no vertex is farther from a particle than a cell is wide.
    VecX along = VecX::Zero(3 * lattice.particle_count());
    for (int p = 0; p < lattice.particle_count(); ++p) {
      along.setZero();
      along[3 * p] = 1;
      const std::vector<Vec3> weights = held.positions(along);
      for (const Vec3& w : weights) CHECK((w[0] > -1e-6 && w[0] < 1 + 1e-6));
      if (p > 40) break;
    }
    const LatticeSize size = lattice_size(ball, spacing);
    CHECK(size.particles > 0.6 * lattice.particle_count());
    CHECK(size.particles < 2 * lattice.particle_count());
  }
  const Lattice cube = filled_lattice(drape::box({0.4, 0.6, 0.2}), 0.1, "box");
  CHECK(cube.particle_count() == 5 * 7 * 3);
  CHECK(volume_of(cube) == Approx(0.048).epsilon(1e-12));
  CHECK_THROWS_AS(filled_lattice(grid(4, 4, 1, 1), 0.1, "sheet.obj"), InputError);
}

TEST_CASE("a carried surface follows rigid and affine motions exactly", "[soft]") {
  TriangleMesh ball = drape::sphere(2, 0.3);
  ball.positions.push_back({0.9, 0.1, -0.5});  // a vertex without triangles, far outside
  const Lattice lattice = filled_lattice(ball, 0.11, "ball");
  const Embedding held = embedding_in(lattice, ball.positions, 0);
  REQUIRE(held.vertices() == ball.vertex_count());
  Mat3 F = rotation(1.3, {1, -2, 0.5});
  for (const bool turned_only : {true, false}) {
    if (!turned_only) F += 0.4 * Eigen::Map<const Mat3>(random_vector(9, 1, 3).data());
    const std::vector<Vec3> at = held.positions(affine(lattice.positions, F, {3, -1, 2}));
    for (std::size_t v = 0; v < at.size(); ++v)
      CHECK((at[v] - (F * ball.positions[v] + Vec3(3, -1, 2))).norm() < 1e-13);
  }
}

TEST_CASE("the surface of a lattice is closed, outwards, and bounds its cells", "[soft]") {
  std::vector<int> particles;
  for (const Lattice& lattice :
       {box_lattice({4, 3, 5}, {0.1, 0.2, 0.3}), filled_lattice(drape::sphere(3, 0.3), 0.07, "ball")}) {
    const TriangleMesh surface = surface_of(lattice, particles);
    CHECK(solid_of(surface).volume == Approx(volume_of(lattice)).epsilon(1e-12));
    for (std::size_t v = 0; v < particles.size(); ++v)
      CHECK(surface.positions[v] == lattice.positions[particles[v]]);
    double signed_volume = 0;
    for (const Triangle& t : surface.triangles)
      signed_volume +=
          surface.positions[t[0]].dot(surface.positions[t[1]].cross(surface.positions[t[2]])) / 6;
    CHECK(signed_volume > 0);
  }
  surface_of(box_lattice({4, 3, 5}, Vec3::Constant(0.1)), particles);
  CHECK(particles.size() == 60 - 2 * 1 * 3);
}

TEST_CASE("bad soft bodies are refused with the field's name", "[soft]") {
  const Lattice flat = box_lattice({3, 3, 3}, {0.1, 0.1, 0.2});
  const auto refused = [&](const SoftMaterial& material, const std::string& word) {
    INFO(word);
    CHECK_THROWS_WITH(soft_body(flat, material), Catch::Contains(word));
  };
  refused({.young = 1e4}, "cubic cells");
  refused({.density = -1}, "density");
  refused({.mass = 0}, "mass");
  refused({.young = {}, .structural = -1}, "structural");
  refused({.young = {}, .shear = -1}, "shear");
  refused({.young = {}, .bend = NAN}, "bend");
  refused({.damping = -1}, "damping");
  CHECK_THROWS_WITH(box_lattice({3, 1, 3}, Vec3::Ones()), Catch::Contains("at least 2"));
}
