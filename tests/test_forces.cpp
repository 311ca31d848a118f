// Laws that every force obeys, over the list of forces: gradient, Hessian, rest, rigid motion, momentum.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <set>
#include <tuple>

#include "mesh/obj/obj.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/damping.h"
#include "solver/forces/linear_spring.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/rope_laws.h"
#include "solver/forces/seam_spring.h"
#include "solver/forces/soft.h"
#include "solver/forces/tension_spring.h"
#include "tests/places.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

// A law with rest data that shows all its branches.
struct Stretch {
  using Law = TensionSpring;
  static Law::Rest rest() { return {0.7, 120}; }
  static std::vector<double> kinks() { return {0.7}; }
};
struct Weld {
  using Law = TensionSpring;
  static Law::Rest rest() { return {0, 50}; }
  static std::vector<double> kinks() { return {}; }
};
struct Linear {
  using Law = LinearSpring;
  static Law::Rest rest() { return {0.7, 120}; }
  static std::vector<double> kinks() { return {}; }
};
struct Bend {
  using Law = BucklingSpring;
  static Law::Rest rest() { return BucklingSpring::rest(0.7, 0.3, 200); }
  static std::vector<double> kinks() { return {0.7, 0.7 * (1 - rest().crossing)}; }
};
struct BendAlwaysClamped {
  using Law = BucklingSpring;
  static Law::Rest rest() { return BucklingSpring::rest(0.7, 3, 200); }
  static std::vector<double> kinks() { return {0.7}; }
};
struct RopeSegment {
  using Law = RopeStretch;
  static Law::Rest rest() { return {0.7, 120}; }
  static std::vector<double> kinks() { return {}; }
};
using Laws = std::tuple<Stretch, Weld, Linear, RopeSegment, Bend, BendAlwaysClamped>;

bool near_kink(const std::vector<double>& kinks, double l) {
  for (double k : kinks)
    if (std::abs(l - k) < 1e-3) return true;
  return false;
}

// A closed network of pairs over random points, all with the same rest data.
template <class Case>
struct Network {
  using Force = PairForce<typename Case::Law>;
  Force force;
  BlockPattern pattern;
  VecX x;

  explicit Network(unsigned seed) : force(elements()), pattern(8, pairs()), x(random_vector(24, 0.5, seed)) {
    force.bind(pattern);
  }

  static std::vector<typename Force::Element> elements() {
    std::vector<typename Force::Element> all;
    for (int i = 0; i < 8; ++i)
      for (int j = i + 1; j < 8; j += 2) all.push_back({i, j, Case::rest()});
    return all;
  }
  static std::vector<ParticlePair> pairs() {
    std::vector<ParticlePair> all;
    for (const auto& e : elements()) all.push_back({e.particles[0], e.particles[1]});
    return all;
  }
  VecX f(const VecX& at) const {
    VecX sum = VecX::Zero(at.size());
    force.add_force(at, VecX::Zero(at.size()), sum);
    return sum;
  }
  // K in particle order, through the assembled matrix: b += -K y tells K y, the matrix tells K itself.
  Eigen::MatrixXd stiffness() const {
    BlockMatrix A(std::make_shared<const BlockPattern>(pattern));
    A.set_to_mass(std::vector<double>(8, 0.0));
    VecX b = VecX::Zero(24);
    force.add_linearised(x, VecX::Zero(24), VecX::Zero(24), 1.0, Stiffness::tangent, A, b);
    Eigen::MatrixXd K(24, 24);
    VecX row = VecX::Zero(24), out(24), column(24);
    for (Eigen::Index k = 0; k < 24; ++k) {
      column.setZero();
      column[k] = 1;
      to_rows(pattern, column, row);
      A.multiply(row, out);
      to_particles(pattern, out, column);
      K.col(k) = column;
    }
    return K;
  }
};

// One force of every kind that depends on positions and velocities alone, and where its particles are at
// rest. (The force of contacts with faces depends on which contacts there are, too.)
struct Resting {
  std::unique_ptr<Force> force;
  VecX x;
};
std::vector<Resting> one_of_every_kind() {
  std::vector<Resting> all;
  const TriangleMesh sheet = grid(9, 8, 0.8, 0.7);
  const Fabric fabric{.area_density = 0.2, .stretch = 300, .bend = 1e-4, .damping = 1e-2};
  const VecX flat = at_rest(sheet).x;
  for (auto& force : noh_jung(sheet, fabric)) all.push_back({std::move(force), flat});
  const TriangleMesh quads = read_obj(source_dir() + "/data/meshes/sheet-625.obj");
  for (auto& force : choi_ko(quads, fabric)) all.push_back({std::move(force), at_rest(quads).x});
  const Lattice block = box_lattice({5, 4, 4}, Vec3(0.1, 0.1, 0.1));
  VecX corners(3 * static_cast<Eigen::Index>(block.positions.size()));
  for (std::size_t i = 0; i < block.positions.size(); ++i)
    corners.segment<3>(3 * static_cast<Eigen::Index>(i)) = block.positions[i];
  for (auto& force : soft_body(block, {.damping = 0.3})) all.push_back({std::move(force), corners});
  std::vector<PairForce<SeamSpring>::Element> stitches;
  std::vector<PairDamping::Element> pairs;
  for (int i = 0; i < 8; ++i) {
    stitches.push_back({i, i + 9, {{0.02, 400}, 0.1}});
    pairs.push_back({i, i + 9});
  }
  all.push_back({std::make_unique<PairForce<SeamSpring>>(stitches, 0.2), flat});
  for (const DampingKind kind : {DampingKind::relative, DampingKind::axial})
    all.push_back({std::make_unique<PairDamping>(pairs, 0.4, kind), flat});
  return all;
}

// All that a force answers at one place.
struct Answers {
  double energy, dissipation;
  VecX f, b, A;  // A: the values of the matrix

  bool same_as(const Answers& o) const {
    VecX mine(2), others(2);
    mine << energy, dissipation;
    others << o.energy, o.dissipation;
    return same_bits(mine, others) && same_bits(f, o.f) && same_bits(b, o.b) && same_bits(A, o.A);
  }
};
Answers ask(const Force& force, const std::shared_ptr<const BlockPattern>& pattern, const VecX& x,
            const VecX& v) {
  Answers a{0, 0, VecX::Zero(x.size()), VecX::Zero(x.size()), {}};
  BlockMatrix A(pattern);
  A.set_to_mass(std::vector<double>(static_cast<std::size_t>(pattern->rows()), 0.0));
  force.add_linearised(x, v, 0.1 * v, 0.02, Stiffness::majorant, A, a.b);
  a.A = Eigen::Map<const VecX>(A.block(0), 9 * pattern->blocks());
  force.add_force(x, v, a.f);
  a.dissipation = force.dissipation(x, v);
  a.energy = force.energy(x);
  return a;
}

}  // namespace

TEST_CASE(
    "a force is a pure function: asked twice, and after other questions, it says the same to the last bit",
    "[forces]") {
  std::set<std::string_view> asked;
  for (const Resting& resting : one_of_every_kind()) {
    Force& force = *resting.force;
    INFO(force.name());
    asked.insert(force.name());
    std::vector<ParticlePair> pairs;
    force.list_pairs(pairs);
    REQUIRE_FALSE(pairs.empty());
    const auto n = resting.x.size();
    const auto pattern = std::make_shared<const BlockPattern>(static_cast<int>(n / 3), pairs);
    force.bind(*pattern);
    const VecX v = random_vector(n, 0.5, 2), w = random_vector(n, 0.5, 3);
    const VecX here = resting.x + random_vector(n, 0.05, 4), there = 0.8 * here + 0.1 * w;

    const double energy = force.energy(here);
    CHECK(force.energy(here) == energy);
    const Answers first = ask(force, pattern, here, v);
    CHECK(first.energy == energy);
    const Answers elsewhere = ask(force, pattern, there, w);
    CHECK(force.energy(here) == energy);
    CHECK(first.same_as(ask(force, pattern, here, v)));
    force.energy(here);
    CHECK(elsewhere.same_as(ask(force, pattern, there, w)));
    VecX f = VecX::Zero(n);
    force.add_force(there, v, f);
    CHECK(force.energy(here) == energy);
    CHECK(first.same_as(ask(force, pattern, here, v)));
    CHECK_FALSE(first.same_as(elsewhere));  // the two places are not alike
  }
  CHECK(asked.size() >= 5);
}

TEMPLATE_LIST_TEST_CASE("a pair law: tension is the slope of the energy, stiffness the slope of the tension",
                        "[forces]", Laws) {
  using Law = typename TestType::Law;
  const auto rest = TestType::rest();
  const double h = 1e-6;
  for (double l = 0.01; l < 1.2; l += 0.0173) {
    if (near_kink(TestType::kinks(), l)) continue;
    INFO("l = " << l);
    const Tension law = Law::tension(rest, l);
    const double slope = (Law::energy(rest, l + h) - Law::energy(rest, l - h)) / (2 * h);
    const double curvature = (Law::tension(rest, l + h).t - Law::tension(rest, l - h).t) / (2 * h);
    CHECK(law.t == Approx(slope).epsilon(1e-7).margin(1e-6));
    CHECK(law.dt == Approx(curvature).epsilon(1e-6).margin(1e-5));
  }
}

TEMPLATE_LIST_TEST_CASE("a pair law: the energy is continuous across its branches, and least at rest",
                        "[forces]", Laws) {
  using Law = typename TestType::Law;
  const auto rest = TestType::rest();
  for (double kink : TestType::kinks()) {
    INFO("l = " << kink);
    CHECK(std::abs(Law::energy(rest, kink * (1 + 1e-9)) - Law::energy(rest, kink * (1 - 1e-9))) < 1e-6);
  }
  CHECK(Law::energy(rest, rest.L) == Approx(0).margin(1e-15));
  for (double l = 0.01; l < 1.2; l += 0.05) CHECK(Law::energy(rest, l) >= 0);
}

TEMPLATE_LIST_TEST_CASE("a pair force is minus the gradient of its energy", "[forces]", Laws) {
  for (unsigned seed : {1u, 2u, 3u}) {
    Network<TestType> net(seed);
    const VecX f = net.f(net.x);
    for (Eigen::Index k = 0; k < net.x.size(); ++k) {
      VecX plus = net.x, minus = net.x;
      plus[k] += 1e-6;
      minus[k] -= 1e-6;
      CHECK(f[k] ==
            Approx(-(net.force.energy(plus) - net.force.energy(minus)) / 2e-6).epsilon(1e-5).margin(1e-4));
    }
  }
}

TEMPLATE_LIST_TEST_CASE("the assembled stiffness is the positive semidefinite part of the exact one",
                        "[forces]", Laws) {
  using Force = PairForce<typename TestType::Law>;
  for (unsigned seed : {4u, 5u, 6u, 7u}) {
    Network<TestType> net(seed);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(24, 24);
    bool smooth = true;
    for (const auto& e :
         net.force.elements()) {  // element by element: exact by differences, clamped by eigenvalues
      const auto [i, j] = e.particles;
      Force one({{i, j, e.rest}});
      smooth =
          smooth && !near_kink(TestType::kinks(),
                               (net.x.template segment<3>(3 * i) - net.x.template segment<3>(3 * j)).norm());
      Mat3 exact;
      for (int k = 0; k < 3; ++k) {
        VecX plus = net.x, minus = net.x, fp = VecX::Zero(24), fm = fp;
        plus[3 * i + k] += 1e-6;
        minus[3 * i + k] -= 1e-6;
        one.add_force(plus, fp, fp);
        one.add_force(minus, fm, fm);
        exact.col(k) = -(fp - fm).template segment<3>(3 * i) / 2e-6;
      }
      const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (exact + exact.transpose()));
      const Mat3 part = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
                        eigen.eigenvectors().transpose();
      expected.block<3, 3>(3 * i, 3 * i) += part;
      expected.block<3, 3>(3 * j, 3 * j) += part;
      expected.block<3, 3>(3 * i, 3 * j) -= part;
      expected.block<3, 3>(3 * j, 3 * i) -= part;
    }
    const Eigen::MatrixXd K = net.stiffness();
    if (smooth) CHECK((K - expected).norm() < 1e-5 * (1 + expected.norm()));
    CHECK((K - K.transpose()).norm() == 0);
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff() > -1e-10 * K.norm());
    // K y, as the right-hand side uses it, is the same K.
    const VecX y = random_vector(24, 1, seed + 100);
    BlockMatrix A(std::make_shared<const BlockPattern>(net.pattern));
    VecX b = VecX::Zero(24);
    net.force.add_linearised(net.x, y, y, 0.5, Stiffness::tangent, A, b);
    CHECK((b - 0.5 * (net.f(net.x) - K * y)).norm() < 1e-12 * (1 + b.norm()));
  }
}

TEMPLATE_LIST_TEST_CASE("the majorant stiffness is that of a parabola above the energy of a lengthening pair",
                        "[forces]", Laws) {
  using Law = typename TestType::Law;
  const auto rest = TestType::rest();
  for (double l = 0.01; l < 1.1; l += 0.037) {
    const Tension law = Law::tension(rest, l);
    const double k = std::max(law.dt, Law::stiffest(rest, l));
    for (double to = l; to < 1.1; to += 0.041) {
      INFO(l << " to " << to);
      CHECK(Law::energy(rest, to) <=
            Law::energy(rest, l) + law.t * (to - l) + 0.5 * k * (to - l) * (to - l) + 1e-9);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("internal forces carry no momentum, no torque, and no energy of rigid motion",
                        "[forces]", Laws) {
  Network<TestType> net(8);
  const VecX f = net.f(net.x);
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (Eigen::Index i = 0; i < 8; ++i) {
    sum += f.segment<3>(3 * i);
    torque += Vec3(net.x.template segment<3>(3 * i)).cross(Vec3(f.segment<3>(3 * i)));
  }
  CHECK(sum.norm() < 1e-12 * (1 + f.norm()));
  CHECK(torque.norm() < 1e-12 * (1 + f.norm()));
  const Mat3 R = rotation(1.1, {1, 2, -1});
  const VecX turned = moved_rigidly(net.x, R, {3, -1, 2});
  CHECK(net.force.energy(turned) == Approx(net.force.energy(net.x)).epsilon(1e-12).margin(1e-14));
  CHECK((net.f(turned) - moved_rigidly(f, R, Vec3::Zero())).norm() < 1e-10 * (1 + f.norm()));
}

TEST_CASE("coincident particles: no direction, no force, and nothing that is not a number", "[forces]") {
  BlockPattern pattern(2, {{0, 1}});
  PairForce<BucklingSpring> bend({{0, 1, BucklingSpring::rest(0.1, 1e-6, 100)}});
  PairForce<TensionSpring> weld({{0, 1, {0, 30}}});
  bend.bind(pattern);
  weld.bind(pattern);
  const VecX x = VecX::Zero(6);
  VecX f = x;
  bend.add_force(x, x, f);
  weld.add_force(x, x, f);
  CHECK(f.norm() == 0);
  BlockMatrix A(std::make_shared<const BlockPattern>(pattern));
  VecX b = VecX::Zero(6);
  bend.add_linearised(x, x, x, 1, Stiffness::tangent, A, b);
  CHECK(b.norm() == 0);
  CHECK(A.at(pattern.diagonal(0)).norm() == 0);
  weld.add_linearised(x, x, x, 1, Stiffness::tangent, A, b);
  CHECK((A.at(pattern.diagonal(0)) - 30 * Mat3::Identity()).norm() == 0);
}

TEST_CASE("a spring that is damped is a spring and a damper along it, to round-off", "[forces]") {
  std::vector<PairForce<LinearSpring>::Element> springs;
  std::vector<PairDamping::Element> pairs;
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 2}, {2, 3}}) {
    springs.push_back({i, j, {0.7, 30}});
    pairs.push_back({i, j});
  }
  PairForce<LinearSpring> both(springs, 0.4), spring(springs);
  PairDamping damper(pairs, 0.4, DampingKind::axial);
  const auto pattern = std::make_shared<const BlockPattern>(4, [&] {
    std::vector<ParticlePair> all;
    both.list_pairs(all);
    return all;
  }());
  const VecX x = random_vector(12, 1, 3), v = random_vector(12, 1, 4), y = random_vector(12, 0.1, 5);
  VecX f = VecX::Zero(12), g = f, b = f, c = f, product(12), other(12);
  both.bind(*pattern);
  both.add_force(x, v, f);
  BlockMatrix A(pattern), B(pattern);
  A.set_to_mass({0, 0, 0, 0});
  B.set_to_mass({0, 0, 0, 0});
  both.add_linearised(x, v, y, 0.1, Stiffness::tangent, A, b);
  for (Force* part : {static_cast<Force*>(&spring), static_cast<Force*>(&damper)}) {
    part->bind(*pattern);
    part->add_force(x, v, g);
    part->add_linearised(x, v, y, 0.1, Stiffness::tangent, B, c);
  }
  CHECK((f - g).norm() < 1e-13 * f.norm());
  CHECK((b - c).norm() < 1e-13 * b.norm());
  A.multiply(v, product);
  B.multiply(v, other);
  CHECK((product - other).norm() < 1e-13 * product.norm());
  CHECK(both.dissipation(x, v) == Approx(damper.dissipation(x, v)).epsilon(1e-13));
  CHECK(spring.dissipation(x, v) == 0);
  f.setZero();
  PairForce<LinearSpring>({{0, 1, {0.7, 30}}}, 0.4).add_force(VecX::Zero(6), VecX::Ones(6), f);
  CHECK(f.norm() == 0);  // coincident: no direction
}

TEST_CASE("damping resists relative motion only, and never drives", "[forces]") {
  for (DampingKind kind : {DampingKind::relative, DampingKind::axial}) {
    BlockPattern pattern(3, {{0, 1}, {1, 2}});
    PairDamping damping({{0, 1}, {1, 2}}, 0.4, kind);
    damping.bind(pattern);
    const VecX x = random_vector(9, 1, 3), v = random_vector(9, 1, 4);
    VecX uniform(9), f = VecX::Zero(9);
    uniform << 1, 2, 3, 1, 2, 3, 1, 2, 3;
    damping.add_force(x, uniform, f);
    CHECK(f.norm() < 1e-15);
    damping.add_force(x, v, f);
    CHECK(f.dot(v) < 0);
    CHECK((f.segment<3>(0) + f.segment<3>(3) + f.segment<3>(6)).norm() < 1e-14);
    // D is minus the slope of the force in v.
    BlockMatrix A(std::make_shared<const BlockPattern>(pattern));
    VecX b = VecX::Zero(9), row(9), out(9), Dv(9);
    damping.add_linearised(x, v, VecX::Zero(9), 0.1, Stiffness::tangent, A, b);
    CHECK((b - 0.1 * f).norm() < 1e-15);
    to_rows(pattern, v, row);
    A.multiply(row, out);
    to_particles(pattern, out, Dv);
    CHECK((Dv + 0.1 * f).norm() < 1e-14);
  }
}

TEST_CASE("immediate buckling agrees with the 50-digit table to 1e-12", "[forces][reference]") {
  const auto table = reference_table("immediate_buckling.csv");
  REQUIRE(table.size() >= 25);
  for (const auto& row : table) {  // lambda, u, kappa L, E, f, df
    INFO("l/L = " << row[0]);
    const Buckling b = immediate_buckling(1 - row[0]);
    // Near the straight state 1 - lambda itself has only so many digits.
    const double digits = row[0] < 1 ? 1e-12 + 4e-16 / (1 - row[0]) : 1e-12;
    CHECK(std::abs(b.energy - row[3]) <= digits * std::max(row[3], 1e-300));
    CHECK(std::abs(b.force - row[4]) <= 1e-12 * std::abs(row[4]));
    CHECK(std::abs(b.stiffness - row[5]) <= 1e-12 * std::abs(row[5]));
  }
}

TEST_CASE("immediate buckling keeps its digits arbitrarily near the straight state", "[forces][reference]") {
  for (double delta = 1e-14; delta < 1e-3;
       delta *= 7) {  // E = 12 delta + 3.6 delta^2 + ..., f = -12 - 7.2 delta - ...
    const Buckling b = immediate_buckling(delta);
    CHECK(b.energy == Approx(12 * delta + 3.6 * delta * delta).epsilon(1e-12 + delta * delta));
    CHECK(b.force == Approx(-12 - 7.2 * delta).epsilon(1e-12 + delta * delta));
  }
}

TEST_CASE("the clamp meets the buckling law where the table says", "[forces][reference]") {
  for (const auto& row : reference_table("immediate_buckling_clamp.csv")) {  // c_hat, delta*, f*, df*
    INFO("c_hat = " << row[0]);
    const double delta = clamp_crossing(row[0]);
    CHECK(delta == Approx(row[1]).epsilon(1e-10));
    CHECK(immediate_buckling(delta).stiffness == Approx(row[3]).epsilon(1e-8));
  }
  CHECK(clamp_crossing(30) == 1);  // never buckles
}
