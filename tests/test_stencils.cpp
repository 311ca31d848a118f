// Laws of forces with stencils of 2, 3 and 4 particles, of those that stand and of those that are found anew
// in every step; and the overlay of the matrix that carries their blocks.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <random>
#include <tuple>

#include "solver/forces/damping.h"
#include "solver/forces/linear_spring.h"
#include "solver/forces/membrane.h"
#include "solver/forces/pair_force.h"
#include "solver/forces/rope_laws.h"
#include "solver/forces/woven.h"
#include "solver/integrators/newton_matrix.h"
#include "tests/dense.h"
#include "tests/integrators.h"
#include "tests/outside/forces.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr int particles = 12;

// A spring of two particles by its full 6x6 Hessian, damped, beside the law of the distance alone.
struct SpringLaw {
  static constexpr const char* name = "full-spring";
  static constexpr int particles = 2;
  struct Rest {
    double L, k;
  };
  using Common = double;  // k_d

  static double energy(double, const Rest& r, const Points<2>& X) {
    const double off = (X.col(0) - X.col(1)).norm() - r.L;
    return 0.5 * r.k * off * off;
  }
  static Points<2> gradient(double, const Rest& r, const Points<2>& X) {
    const Vec3 d = X.col(0) - X.col(1);
    Points<2> g;
    g.col(0) = r.k * (1 - r.L / d.norm()) * d;
    g.col(1) = -g.col(0);
    return g;
  }
  static Blocks<2> spread(const Mat3& K) {
    Blocks<2> whole;
    whole << K, -K, -K, K;
    return whole;
  }
  static Blocks<2> hessian(double, const Rest& r, const Points<2>& X, Stiffness) {
    const Vec3 d = X.col(0) - X.col(1), n = d.normalized();
    const double across = std::max(0.0, r.k * (1 - r.L / d.norm()));
    return spread((r.k - across) * n * n.transpose() + across * Mat3::Identity());
  }
  static bool damped(double k_d) { return k_d > 0; }
  static Blocks<2> damping(double k_d, const Rest&, const Points<2>&) {
    return spread(k_d * Mat3::Identity());
  }
};

// Cases: a force over stencils of these particles, and where its energy is smooth.
template <class Law>
std::unique_ptr<Force> over(const std::vector<std::array<int, Law::particles>>& stencils,
                            const typename Law::Rest& rest, typename Law::Common common = {}) {
  std::vector<typename StencilForce<Law>::Element> elements;
  for (const auto& s : stencils) elements.push_back({.particles = s, .rest = rest});
  return std::make_unique<StencilForce<Law>>(std::move(elements), common);
}
template <class Law>
std::unique_ptr<Force> finding(const std::vector<std::array<int, Law::particles>>& stencils,
                               const typename Law::Rest& rest, typename Law::Common common = {}) {
  return std::make_unique<StencilForce<Law>>(
      [=](const StepStart&, std::vector<typename StencilForce<Law>::Element>& found) {
        found.clear();
        for (const auto& s : stencils) found.push_back({.particles = s, .rest = rest});
        return true;
      },
      common);
}

// The same stencils, standing and found anew.
template <class Law>
struct Stencils {
  static std::vector<std::array<int, Law::particles>> all() {
    std::vector<std::array<int, Law::particles>> stencils;
    for (int first = 0; first < particles; ++first) {
      std::array<int, Law::particles> s;
      constexpr std::array<int, 4> offset = {0, 5, 2, 9};  // far apart and in no order
      for (std::size_t k = 0; k < s.size(); ++k) s[k] = (first + offset[k]) % particles;
      stencils.push_back(s);
    }
    return stencils;
  }
};

struct FullSpring {
  using Law = SpringLaw;
  static Law::Rest rest() { return {0.4, 30}; }
  static Law::Common common() { return 0.2; }
};
struct Distance {
  using Law = AlongDistance<LinearSpring>;
  static Law::Rest rest() { return {0.4, 30}; }
  static Law::Common common() { return 0.2; }
};
struct Area {
  using Law = AreaLaw;
  static Law::Rest rest() { return {0.1, 70}; }
  static Law::Common common() { return {}; }
};
struct PointTriangle {
  using Law = PointTriangleLaw;
  static Law::Rest rest() { return {{0.5, 0.2, 0.3}, Vec3(1, 2, -1).normalized(), 0.3, 50}; }
  static Law::Common common() { return {}; }
};
Membrane::Common fabric_of(double compression) {
  Fabric fabric{.stretch = 60};
  fabric.weave = {.stretch_weft = 30,
                  .shear = 12,
                  .poisson = 0.2,
                  .compression = compression,
                  .stretch_time = 0.01,
                  .shear_time = 0.02};
  return membrane_of(fabric);
}
template <int percent>
struct Woven {  // taut in some triangles and slack in others
  using Law = Membrane;
  static Law::Rest rest() {
    Law::Rest rest{.weights = {}, .area = 0.3};
    rest.weights << -1.2, -0.9, 1.4, 0.2, -0.2, 0.7;
    return rest;
  }
  static Law::Common common() { return fabric_of(0.01 * percent); }
};
struct BentRope {
  using Law = RopeBend;
  static Law::Rest rest() { return {0.3, 0.5, 20}; }
  static Law::Common common() { return {}; }
};
template <int percent>
struct DampedRope {  // bent a hundred times as far as q_0, and so little that it is the other way round
  using Law = RopeBendDamping;
  static Law::Rest rest() { return {.a = 0.3, .b = 0.5, .c = 0.4, .least = 0.01 * percent}; }
  static Law::Common common() { return {}; }
};
using Cases = std::tuple<FullSpring, Distance, Area, PointTriangle, BentRope, DampedRope<1>,
                         DampedRope<10000>, Woven<100>, Woven<30>>;

// Of the direct solvers; a multigrid may make its levels anew whenever they work badly.
bool analyses_are_kept(std::string_view solver) { return solver == "cholmod" || solver == "eigen-ldlt"; }

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "a force of any stencil is minus the slope of its energy, and its matrix is that of its "
    "right side",
    "[forces]", Cases) {
  using Law = typename TestType::Law;
  const auto stencils = Stencils<Law>::all();
  REQUIRE(stencils.size() > 5);
  for (const bool found : {false, true}) {
    System system(std::vector<double>(particles, 0.1));
    system.add(found ? finding<Law>(stencils, TestType::rest(), TestType::common())
                     : over<Law>(stencils, TestType::rest(), TestType::common()));
    const VecX x = random_vector(3 * particles, 0.5, 3), v = random_vector(3 * particles, 1, 4),
               y = random_vector(3 * particles, 0.1, 5), still = VecX::Zero(x.size());
    system.begin_step({0, 0.01, x, v});
    const Force& force = *system.forces()[0];
    INFO((found ? "found anew, " : "standing, ") << force.name());

    VecX f = still;
    force.add_force(x, still, f);
    const double energy = force.energy(x);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      VecX up = x, down = x;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      CHECK(f[k] == Approx(-(force.energy(up) - force.energy(down)) / 2e-6).epsilon(1e-5).margin(1e-6));
    }
    CHECK(force.energy(x) == energy);  // a pure function: whatever was asked meanwhile
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < particles; ++i) sum += f.segment<3>(3 * i);
    CHECK(sum.norm() < 1e-12 * (1 + f.norm()));

    BlockMatrix A = system.matrix();
    const double c = 0.1;
    const auto assembled = [&](const VecX& velocity, const VecX& shift, VecX& b) {
      A.set_to_mass(std::vector<double>(particles, 0.0));
      b = still;
      force.add_linearised(x, velocity, shift, c, Stiffness::tangent, A, b);
      return dense(A);
    };
    VecX b, b_y, b_v;
    const Eigen::MatrixXd D2K = assembled(still, still, b);
    CHECK((b - c * f).norm() < 1e-12 * (1 + b.norm()));
    CHECK((D2K - D2K.transpose()).norm() < 1e-14 * D2K.norm());
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(D2K).eigenvalues().minCoeff() > -1e-12 * D2K.norm());
    assembled(still, y, b_y);
    assembled(v, still, b_v);
    // c (-K y) and c (-D v) are those of A = c D + c^2 K: at half the c the two parts have other shares.
    const Eigen::MatrixXd& A1 = D2K;
    A.set_to_mass(std::vector<double>(particles, 0.0));
    VecX half = still;
    force.add_linearised(x, still, still, c / 2, Stiffness::tangent, A, half);
    const Eigen::MatrixXd A2 = dense(A);
    const Eigen::MatrixXd K = (A1 - 2 * A2) / (c * c / 2), D = (4 * A2 - A1) / c;
    CHECK((b_y - b + c * K * y).norm() < 1e-11 * (1 + b.norm() + b_y.norm()));
    CHECK((b_v - b + c * D * v).norm() < 1e-11 * (1 + b.norm() + b_v.norm()));
    CHECK(force.dissipation(x, v) == Approx(0.5 * v.dot(D * v)).epsilon(1e-10).margin(1e-12));
  }
}

TEST_CASE("what is found anew in every step has the same motion as what stands", "[forces]") {
  for (const std::string& name : integrator_names()) {
    if (!bears_stiff(name)) continue;
    State ends[2];
    for (const bool found : {false, true}) {
      System system(std::vector<double>(particles, 0.1));
      const auto stencils = Stencils<AreaLaw>::all();
      system.add(found ? finding<AreaLaw>(stencils, Area::rest()) : over<AreaLaw>(stencils, Area::rest()));
      system.add(Gravity{});
      Constraints constraints;
      constraints.pin({0, 5});
      State state{0, random_vector(3 * particles, 0.5, 3), VecX::Zero(3 * particles)};
      StepOptions options = precise();
      options.projection.iterations = 100;  // pbd takes them in another order
      // Where a step is linearised first depends on what stands, where it ends does not.
      options.newton_iterations = 30;
      auto stepper = make_integrator(name, system, constraints, make_linear_solver("cholmod"), options);
      for (int n = 0; n < 10; ++n) REQUIRE(stepper->advance(state, 0.01).done);
      ends[found] = state;
    }
    INFO(name);
    CHECK((ends[0].x - ends[1].x).norm() < 1e-7);
  }
}

TEST_CASE("every linear solver solves with an overlay of far pairs, and analyses it once", "[solvers]") {
  const TriangleMesh mesh = grid(12, 12, 1, 1);
  const int n = mesh.vertex_count();
  System system(lumped_mass(mesh, 0.2));
  system.add(noh_jung(mesh, {}));
  int shift = 0;
  using Springs = StencilForce<AlongDistance<LinearSpring>>;
  system.add(std::make_unique<Springs>([&](const StepStart&, std::vector<Springs::Element>& found) {
    found.clear();
    for (int i = 0; i < n; i += 5) found.push_back({{i, (i * 37 + 11 + shift) % n}, {0.1, 200}});
    std::erase_if(found, [](const auto& e) { return e.particles[0] == e.particles[1]; });
    return true;
  }));
  const State state = at_rest(mesh);
  const VecX b = random_vector(3 * n, 1, 9), still = VecX::Zero(3 * n);
  Filter filter;
  filter.constrain(3, Mat3::Zero(), Vec3(0.1, 0, 0));
  filter.constrain(40, Mat3::Identity() - Vec3::UnitY() * Vec3::UnitY().transpose(), Vec3::Zero());
  BlockMatrix A = system.matrix();
  for (const auto& info : linear_solvers()) {
    const auto solver = make_linear_solver(info.name);
    for (shift = 0; shift < 3; ++shift) {
      system.begin_step({0, 0.01, state.x, state.v});
      VecX unused = still;
      A.set_to_mass(system.masses());
      for (const auto& force : system.forces())
        force->add_linearised(state.x, state.v, still, 0.01, Stiffness::tangent, A, unused);
      REQUIRE(A.overlay().blocks() > 10);
      for (int again = 0; again < 2; ++again) {
        VecX dv = still;
        const LinearReport report = solver->solve(A, b, filter, {.tolerance = 1e-11}, dv);
        INFO(info.name << ", overlay " << shift);
        CHECK(report.reason == StopReason::converged);
        if (again == 1 && analyses_are_kept(info.name)) CHECK(report.analyses == 0);
        VecX r(3 * n);
        A.multiply(dv, r);
        r -= b;
        filter.apply(r);
        CHECK(r.norm() < 1e-9 * b.norm());
        CHECK(dv.segment<3>(9) == Vec3(0.1, 0, 0));
      }
    }
  }
}

TEST_CASE("what comes and goes is assembled anew beside what was kept, to the last bit", "[solvers]") {
  for (const int side : {6, 60}) {  // by one thread and by several
    const TriangleMesh mesh = grid(side, side, 1, 1);
    const int n = mesh.vertex_count();
    System system(lumped_mass(mesh, 0.2));
    int shift = 0;
    using Springs = StencilForce<AlongDistance<LinearSpring>>;
    system.add(std::make_unique<Springs>([&](const StepStart&, std::vector<Springs::Element>& found) {
      found.clear();
      for (int i = 0; i < n / (1 + shift); i += 5) found.push_back({{i, (i + 7 + shift) % n}, {0.1, 200}});
      return true;
    }));
    system.add(noh_jung(mesh, {}));
    const VecX x = at_rest(mesh).x + random_vector(3 * n, 0.01, 2), v = random_vector(3 * n, 1, 3),
               y = random_vector(3 * n, 0.01, 4), weight = random_vector(3 * n, 1, 5);
    const Linearisation at{x, v, y, 0.01, Stiffness::tangent};
    NewtonMatrix kept(system, nullptr), whole(system, nullptr);
    kept.follow_system();
    whole.follow_system();
    system.begin_step({0, 0.01, x, v});
    VecX b = weight;
    kept.assemble(at, system.masses(), b, true);
    for (shift = 0; shift < 4; ++shift) {
      kept.rub(
          n / 2, [](std::size_t k) { return 2 * static_cast<int>(k); },
          [](std::size_t) { return Mat3(3 * Mat3::Identity()); });
      system.begin_step({0, 0.01, x, v});
      const std::uint64_t before = kept.matrix().fill();
      VecX expected = weight;
      kept.assemble_changing(at, b);
      whole.assemble(at, system.masses(), expected);
      INFO(side << ", " << shift);
      CHECK(kept.matrix().fill() != before);
      CHECK(b == expected);
      const int blocks = kept.matrix().pattern().blocks() + kept.matrix().overlay().blocks();
      CHECK(kept.matrix().overlay().blocks() > 0);
      CHECK(std::equal(kept.matrix().block(0), kept.matrix().block(blocks), whole.matrix().block(0)));
    }
  }
}

TEST_CASE("a product with an overlay is that of the dense matrix, the same bits on any number of threads",
          "[solvers]") {
  const TriangleMesh mesh = grid(60, 60, 1, 1);
  System system(lumped_mass(mesh, 1));
  system.add(noh_jung(mesh, {}));
  const auto pattern = system.bind();
  std::mt19937 engine(5);
  std::vector<ParticlePair> far;
  for (int k = 0; k < 4000; ++k)
    far.push_back({static_cast<int>(engine() % 3600u), static_cast<int>(engine() % 3600u)});
  const auto overlay = std::make_shared<BlockOverlay>();
  std::vector<ParticlePair> same = far;
  CHECK(overlay->assign(*pattern, far));
  CHECK_FALSE(overlay->assign(*pattern, same));
  BlockMatrix A(pattern, overlay);
  const VecX numbers = random_vector(9 * (pattern->blocks() + overlay->blocks()), 1, 5),
             x = random_vector(3 * A.rows(), 1, 6);
  for (int s = 0; s < pattern->blocks() + overlay->blocks(); ++s)
    A.at(s) = Eigen::Map<const Mat3>(numbers.data() + 9 * static_cast<std::ptrdiff_t>(s));
  VecX expected = VecX::Zero(x.size()), y = expected;
  int blocks = 0;
  for (int r = 0; r < A.rows(); ++r) {
    int last = -1;
    A.each(r, [&](int c, int slot) {
      CHECK(c > last);
      last = c;
      ++blocks;
      expected.segment<3>(3 * r) += A.at(slot) * x.segment<3>(3 * c);
      if (c > r) expected.segment<3>(3 * c) += A.at(slot).transpose() * x.segment<3>(3 * r);
    });
  }
  CHECK(blocks == pattern->blocks() + overlay->blocks());
  const ThreadsRestored restored;
  VecX first;
  for (int t : {1, 2, 7}) {
    set_threads(t);
    A.multiply(x, y);
    CHECK((y - expected).norm() <= 1e-13 * expected.norm());
    if (first.size() == 0) first = y;
    CHECK(y == first);
  }
}

TEST_CASE("what is added to the diagonal replaces what was added before, to the last bit", "[solvers]") {
  const TriangleMesh mesh = grid(5, 5, 1, 1);
  System system(lumped_mass(mesh, 0.3));
  system.add(noh_jung(mesh, {}));
  BlockMatrix A = system.matrix();
  A.set_to_mass(system.masses());
  const Mat3 before = A.at(A.pattern().diagonal(4));
  const std::vector<DiagonalBlock> first = {{4, 0.1 * Mat3::Ones()}, {7, Mat3::Identity()}},
                                   second = {{7, 3 * Mat3::Identity()}};
  A.set_diagonal_additions(first);
  CHECK(A.at(A.pattern().diagonal(4)) == Mat3(before + 0.1 * Mat3::Ones()));
  A.set_diagonal_additions(second);
  CHECK(A.at(A.pattern().diagonal(4)) == before);
  A.set_diagonal_additions({});
  CHECK(A.at(A.pattern().diagonal(7)) ==
        Mat3(system.masses()[A.pattern().particle_of()[7]] * Mat3::Identity()));
}

TEST_CASE("products leave out the far blocks that are zero, with the same bits", "[solvers]") {
  const TriangleMesh mesh = grid(12, 12, 1, 1);
  const int n = mesh.vertex_count();
  System system(lumped_mass(mesh, 0.2));
  system.add(noh_jung(mesh, {}));
  int round = 0;
  using Springs = StencilForce<AlongDistance<LinearSpring>>;
  system.add(std::make_unique<Springs>([&](const StepStart&, std::vector<Springs::Element>& found) {
    found.clear();
    for (int i = 0; i < n; ++i)
      if (const int j = (i * 37 + 11) % n; j != i)
        found.push_back({{i, j}, {0.1, (i + round) % 3 == 0 ? 200.0 : 0.0}});
    return true;
  }));
  const State state = at_rest(mesh);
  const VecX x = random_vector(3 * n, 1, 9), still = VecX::Zero(3 * n);
  BlockMatrix A = system.matrix();
  for (; round < 3; ++round) {
    system.begin_step({0, 0.01, state.x, state.v});
    BlockMatrix fresh = system.matrix();
    for (BlockMatrix* matrix : {&A, &fresh}) {
      VecX unused = still;
      matrix->set_to_mass(system.masses());
      for (const auto& force : system.forces())
        force->add_linearised(state.x, state.v, still, 0.01, Stiffness::tangent, *matrix, unused);
    }
    int zero = 0;
    for (int k = 0; k < A.overlay().blocks(); ++k) zero += A.at(A.pattern().blocks() + k).isZero(0);
    REQUIRE(zero > A.overlay().blocks() / 3);
    REQUIRE(zero < A.overlay().blocks());
    VecX whole(3 * n), before(3 * n), after(3 * n);
    fresh.multiply(x, whole);
    A.multiply(x, before);
    A.leave_out_zeros();
    A.multiply(x, after);
    CHECK(before == whole);
    CHECK(after == whole);
  }
}
