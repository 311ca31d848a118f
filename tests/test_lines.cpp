// Laws of single lines: each was written because breaking that line failed no other test.
#include <sys/resource.h>
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <csignal>

#include "app/base/atomic_file.h"
#include "app/base/units.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/damping.h"
#include "solver/forces/tension_spring.h"
#include "tests/folder.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
namespace fs = std::filesystem;

namespace {
std::vector<PairForce<BucklingSpring>::Element> bends(const std::vector<std::unique_ptr<Force>>& forces) {
  for (const auto& f : forces)
    if (const auto* b = dynamic_cast<const PairForce<BucklingSpring>*>(f.get())) return b->elements();
  return {};
}
int simulate(const Folder& d, const std::string& words) {
  const TriangleMesh sheet = grid(3, 3, 1, 1);
  write_obj(d.path / "sheet.obj", sheet, sheet.positions);
  d.write("s.toml",
          "[[cloth]]\nmesh = \"sheet.obj\"\nfabric = \"cotton-poplin\"\nimperfection = 0\n[simulation]\n");
  return d.drape("simulate s.toml --quiet --out o " + words).exit_code;
}
}  // namespace

TEST_CASE("a last step that is shorter moves the cloth by no more", "[cli]") {
  const Folder d;
  REQUIRE(simulate(d, "--duration 0.05 --time-step 0.02") == 0);
  const double y = read_obj(d.path / "o/sheet.obj").positions[4].y();
  CHECK(y == Approx(-9.81 * (0.02 * 0.02 + 0.02 * 0.04 + 0.01 * 0.05)).epsilon(1e-6));
}

TEST_CASE("a frame is due in spite of round-off in its time", "[cli]") {
  const Folder d;
  REQUIRE(simulate(d, "--duration 0.29 --time-step 0.01 --set simulation.frame_rate=100") == 0);
  CHECK(fs::file_size(d.path / "o/sheet.pc2") == 32 + 30 * 9 * 12);
}

TEST_CASE("the clamp lies between the stretch of an edge and the stiffest one allowed", "[fabric]") {
  for (double edge : {0.1, 0.02, 0.002})
    for (const auto& e : bends(noh_jung(equilateral_sheet(5, 5, edge), {.stretch = 500, .bend = 1e-5}))) {
      CHECK(e.rest.c_b >= 500 * (1 - 1e-12));
      CHECK(e.rest.c_b <= stiffest_clamp * 500 * (1 + 1e-12));
    }
}

TEST_CASE("a box pins what lies on its sides", "[contact]") {
  CHECK(select(PinBox{{-0.5, 0, -0.5}, {0.5, 0, -0.5}}, grid(3, 3, 1, 1)) == std::vector<int>{0, 1, 2});
}

TEST_CASE("what the solution would drive through a surface is caught within the equations", "[contact]") {
  // Pulled down by a spring in one step: the prediction (no gravity) does not meet
  // the plane, the solution does.
  System system({0.01, 0.01});
  std::vector<PairForce<TensionSpring>::Element> e;
  e.push_back({0, 1, {0.1, 100}});
  system.add(std::make_unique<PairForce<TensionSpring>>(std::move(e)));
  Constraints constraints;
  constraints.pin(0);
  constraints.add(Obstacle{.shape = Plane{}});
  State state{0, VecX::Zero(6), VecX::Zero(6)};
  state.x << 0, -0.5, 0, 0, 0.05, 0;
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"));
  const StepReport report = stepper.advance(state, 0.02);
  CHECK(report.guarded == 0);
  CHECK(report.contacts == 1);
  CHECK(state.x[4] == Approx(2e-3).margin(1e-9));
}

TEST_CASE("in a corner the wall lets go that would pull", "[contact]") {
  for (const Vec3& g : {Vec3(3, -9.81, 0), Vec3(-3, 9.81, 0)}) {
    System system({0.01});
    Constraints constraints;
    for (const Vec3& n : {Vec3(0, 1, 0), Vec3(1, 0, 0)})
      constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, n}, .friction = 0.0, .margin = 0});
    State state{0, VecX::Zero(3), VecX::Zero(3)};
    ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"));
    system.add(Gravity{{-3, -9.81, 0}});
    for (int n = 0; n < 5; ++n) stepper.advance(state, 0.01);
    CHECK(state.x.norm() < 1e-12);
    system.add(Gravity{g});
    for (int n = 0; n < 10; ++n) stepper.advance(state, 0.01);
    const double way = 1e-4 * 55;
    CHECK(state.x[0] == Approx(std::max(g[0], 0.0) * way).margin(1e-12));
    CHECK(state.x[1] == Approx(std::max(g[1], 0.0) * way).margin(1e-12));
  }
}

TEST_CASE("a sheet at rest resists at once, however it lies, and an edge that is slack does not",
          "[forces]") {
  const TriangleMesh mesh = grid(7, 7, 0.7, 0.7);
  System system(lumped_mass(mesh, 0.2));
  system.add(noh_jung(mesh, {.stretch = 300, .bend = 0}));
  BlockMatrix A(system.bind());
  const VecX x = stacked(mesh.positions), none = VecX::Zero(x.size()), y = random_vector(x.size(), 1, 3);
  const auto stiffness_times = [&](const VecX& at, const VecX& direction) {
    VecX b = none;
    for (const auto& force : system.forces())
      force->add_linearised(at, none, direction, 1, Stiffness::tangent, A, b);
    return b;
  };
  const VecX expected = stiffness_times(x, y);
  CHECK(expected.norm() > 100);
  for (int k = 1; k <= 5; ++k) {  // lengths to round-off
    const Mat3 R = rotation(k, Vec3(1, k, -2));
    const VecX turned = moved_rigidly(x, R, Vec3(k, -3, 2));
    CHECK((stiffness_times(turned, moved_rigidly(y, R, Vec3::Zero())) -
           moved_rigidly(expected, R, Vec3::Zero()))
              .norm() < 1e-9 * expected.norm());
  }
  const TensionSpring::Rest edge{0.1, 300};
  CHECK(TensionSpring::tension(edge, 0.1 * (1 - 1e-9)).t == 0);
  CHECK(TensionSpring::tension(edge, 0.1 * (1 - 1e-9)).dt == 0);
}

TEST_CASE("damping forces are the slope of the dissipation", "[forces]") {
  for (DampingKind kind : {DampingKind::relative, DampingKind::axial}) {
    PairDamping damping({{0, 1}, {1, 2}}, 0.4, kind);
    const VecX x = random_vector(9, 1, 3), v = random_vector(9, 1, 4);
    VecX f = VecX::Zero(9);
    damping.add_force(x, v, f);
    CHECK(damping.dissipation(x, v) == Approx(-0.5 * f.dot(v)));  // f = -d Psi / dv
  }
}

namespace {
struct Small {
  BlockMatrix A;
  VecX b;
  explicit Small(const std::vector<ParticlePair>& pairs, int n)
      : A(std::make_shared<const BlockPattern>(n, pairs)), b(random_vector(3 * n, 1, 8)) {
    A.set_to_mass(std::vector<double>(static_cast<std::size_t>(n), 1.0));
    const auto& row = A.pattern().row_of();
    for (const auto& p : pairs) {
      const int i = row[p.i], j = row[p.j];
      A.at(A.pattern().diagonal(i)) += Mat3::Identity();
      A.at(A.pattern().diagonal(j)) += Mat3::Identity();
      A.at(A.pattern().slot(std::min(i, j), std::max(i, j))) -= Mat3::Identity();
    }
  }
};
}  // namespace

TEST_CASE("a solver sees that the pattern is another one of the same size", "[solvers]") {
  for (const auto& info : linear_solvers()) {
    INFO(info.name);
    const auto solver = make_linear_solver(info.name);
    // As many particles, other pairs: a path, a path and a star.
    std::vector<ParticlePair> path, star;
    for (int i = 0; i < 9; ++i) path.push_back({i, i + 1}), star.push_back({0, i + 1});
    for (const auto& pairs : {path, star, path}) {
      Small p(pairs, 10);
      VecX dv = VecX::Zero(30), r(30);
      const LinearReport report = solver->solve(p.A, p.b, Filter{}, {.tolerance = 1e-10}, dv);
      p.A.multiply(dv, r);
      CHECK(report.reason == StopReason::converged);
      CHECK((p.b - r).norm() < 1e-9);
    }
  }
}

TEST_CASE("a bad start does not loosen the tolerance", "[solvers]") {
  std::vector<ParticlePair> path;
  for (int i = 0; i < 199; ++i) path.push_back({i, i + 1});
  Small p(path, 200);
  VecX dv = random_vector(600, 1e3, 2);  // a start far worse than none
  const LinearReport report = make_linear_solver("mpcg")->solve(p.A, p.b, Filter{}, {.tolerance = 1e-3}, dv);
  VecX r(600);
  p.A.multiply(dv, r);
  CHECK(report.reason == StopReason::converged);
  CHECK((p.b - r).norm() <= 1.02e-3 * p.b.norm());
}

TEST_CASE("a residual is relative to the scale where the right-hand side is round-off", "[solvers]") {
  // The size that a residual is compared with is at least `scale`:
  // a right-hand side of round-off is solved at once.
  Small p({{0, 1}}, 2);
  p.b *= 1e-9;
  for (const auto& info : linear_solvers()) {
    VecX dv = VecX::Zero(6);
    const LinearReport report =
        make_linear_solver(info.name)->solve(p.A, p.b, Filter{}, {.tolerance = 1e-6, .scale = 1}, dv);
    INFO(info.name);
    CHECK(report.residual == Approx(report.residual_impulse));
    if (info.name == "mpcg") CHECK(report.iterations == 0);
  }
}

TEST_CASE("two hinges with the same diagonal add up", "[fabric]") {
  TriangleMesh cross, left, right;
  cross.positions = {{0.1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}, {1, 0, 0}};
  left = right = cross;
  cross.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  left.triangles = {{0, 1, 2}, {0, 2, 3}};
  right.triangles = {{0, 3, 4}, {0, 4, 1}};
  const auto k = [](const TriangleMesh& m, const Fabric& f) {
    double sum = 0;
    for (const auto& e : bends(noh_jung(m, f)))
      if (std::minmax(e.particles[0], e.particles[1]) == std::minmax(1, 3)) sum += e.rest.k_b;
    return sum;
  };
  const Fabric f{.bend = 1e-5};
  CHECK(k(left, f) > 0);
  CHECK(k(right, f) != Approx(k(left, f)));
  CHECK(k(cross, f) == Approx(k(left, f) + k(right, f)));
  CHECK(k(cross, {.bend_spring = 3e-7}) == 3e-7);
}

TEST_CASE("a file that does not reach the disk is an error and is not there", "[output]") {
  const Folder d;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{}, none{};
  getrlimit(RLIMIT_FSIZE, &old);
  none = {0, old.rlim_max};
  AtomicFile file(d.path / "a.txt");
  file.write("small");  // stays in the buffer
  setrlimit(RLIMIT_FSIZE, &none);
  std::string said;
  try {
    file.keep();
  } catch (const InputError& e) {
    said = e.what();
  }
  setrlimit(RLIMIT_FSIZE, &old);
  CHECK_THAT(said, Catch::Contains("cannot write: File too large"));
  CHECK_FALSE(fs::exists(d.path / "a.txt"));
}

TEST_CASE("line elements count texture coordinates from the end", "[obj]") {
  const TriangleMesh mesh =
      parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1 2 3\nl -3/-2 -1/-1\n", "l.obj");
  CHECK(mesh.document->warnings.empty());
  CHECK_THAT(format_obj(mesh, mesh.positions), Catch::Contains("l 1/1 3/2\n"));
}

TEST_CASE("a sign stands once, before the number", "[units]") {
  CHECK_THROWS_WITH(parse_quantity("10+20 s", dimension::time), Catch::Contains("is not a unit"));
  CHECK_THROWS_AS(parse_quantity("+-5 s", dimension::time), InputError);
  CHECK_THROWS_AS(parse_quantity("+ 5 s", dimension::time), InputError);
}
