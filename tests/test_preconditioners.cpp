// Laws of the preconditioners, and of solvers that keep something from one system to the next.
#include <catch2/catch.hpp>
#include <limits>

#include "mesh/base/threads.h"
#include "solver/forces/linear_spring.h"
#include "solver/forces/stencil_force.h"
#include "solver/forces/stencil_laws.h"
#include "solver/linear/pcg.h"
#include "tests/falling_sheet.h"

using namespace drape;
using namespace drape::app;
using namespace drape::internal;
using namespace drape::test;

namespace {

// Block-jacobi that after some iterations acts as a negative definite matrix,
// until it is made safer, if it can be.
class Failing final : public Preconditioner {
 public:
  struct Told {
    int safer = 0, learnt = 0;
    double decades = 0;
    bool forgotten = false;
  };
  Failing(int sound, bool can_be_safer, Told& told)
      : sound_(sound), can_be_safer_(can_be_safer), told_(told) {}
  std::string_view name() const override { return "failing"; }
  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    return inner_->prepare(A, filter, report);
  }
  void apply(const VecX& r, VecX& s) override {
    inner_->apply(r, s);
    if (told_.safer == 0 && --sound_ < 0) s = -s;
  }
  bool make_safer(const BlockMatrix&, const Filter&, LinearReport&) override {
    told_.safer += can_be_safer_ ? 1 : 0;
    return can_be_safer_;
  }
  void learn(int iterations, double decades) override {
    told_.learnt = iterations;
    told_.decades = decades;
  }
  void forget() override { told_.forgotten = true; }

 private:
  std::unique_ptr<Preconditioner> inner_ = make_block_jacobi();
  int sound_;
  bool can_be_safer_;
  Told& told_;
};

// Gives no product beside its vector, so that the conjugate gradient multiplies by itself.
class WithoutProduct final : public Preconditioner {
 public:
  std::string_view name() const override { return "without-product"; }
  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    return inner_->prepare(A, filter, report);
  }
  void apply(const VecX& r, VecX& s) override { inner_->apply(r, s); }

 private:
  std::unique_ptr<Preconditioner> inner_ = make_multigrid();
};

// Multigrid whose products are wrong.
class WrongProduct final : public Preconditioner {
 public:
  explicit WrongProduct(double factor) : factor_(factor) {}
  std::string_view name() const override { return "wrong-product"; }
  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    return inner_->prepare(A, filter, report);
  }
  void apply(const VecX& r, VecX& s) override { inner_->apply(r, s); }
  bool apply_and_multiply(const VecX& r, VecX& s, VecX& Bs) override {
    const bool multiplied = inner_->apply_and_multiply(r, s, Bs);
    if (++calls_ > 3) Bs *= factor_;
    return multiplied;
  }

 private:
  std::unique_ptr<Preconditioner> inner_ = make_multigrid();
  double factor_;
  int calls_ = 0;
};

// The matrix of a crumpled sheet in which particles far from each other are coupled, too, and its filter.
struct CoupledSheet {
  using Springs = StencilForce<AlongDistance<LinearSpring>>;
  System system;
  BlockMatrix A;
  Filter filter;

  explicit CoupledSheet(int side, bool far)
      : system(lumped_mass(grid(side, side, 1, 1), 0.2)), A(add_forces(side, far)) {
    const State state = at_rest(grid(side, side, 1, 1));
    const int n = side * side;
    const VecX x = state.x + random_vector(3 * n, 0.2 / side, 6), still = VecX::Zero(3 * n);
    system.begin_step({0, 0.01, x, still});
    A.set_to_mass(system.masses());
    VecX unused = still;
    for (const auto& force : system.forces())
      force->add_linearised(x, still, still, 0.01, Stiffness::majorant, A, unused);
    filter.constrain(0, Mat3::Zero(), Vec3::Zero());
    for (int i = 5; i < n; i += 9) {
      const Vec3 normal = Vec3(0.1 * (i % 7), 1, -0.2).normalized();
      filter.constrain(i, Mat3::Identity() - normal * normal.transpose(), Vec3::Zero());
    }
    filter.renumber(A.pattern().row_of());
  }

 private:
  BlockMatrix add_forces(int side, bool far) {
    const int n = side * side;
    system.add(noh_jung(grid(side, side, 1, 1), {}));
    if (far)
      system.add(std::make_unique<Springs>([=](const StepStart&, std::vector<Springs::Element>& found) {
        found.clear();
        for (int i = 0; i < n; i += 5) found.push_back({{i, (i + n / 2) % n}, {0.1, 2000}});
        return true;
      }));
    return system.matrix();
  }
};

const std::vector<std::string> names = {"block-jacobi", "block-ic0", "multigrid"};

}  // namespace

TEST_CASE("a preconditioner is symmetric and positive definite, the same bits on any number of threads",
          "[solvers]") {
  const FallingSheet sheet(60, 12);  // large enough for threads
  const Filter held = sheet.held({0, 59, 700, 701, 702, 1800, 1801, 1900, 2500});
  const CoupledSheet coupled(60, true);
  const ThreadsRestored restored;
  for (const std::string& name : names)
    for (const bool far : {false, true}) {
      INFO(name << (far ? ", coupled far" : ""));
      const BlockMatrix& A = far ? coupled.A : sheet.stepper.matrix();
      const Filter& filter = far ? coupled.filter : held;
      VecX first;
      for (int t : {1, 2, 7}) {
        set_threads(t);
        const auto preconditioner = make_preconditioner(name);
        LinearReport report;
        REQUIRE(preconditioner->prepare(A, filter, report));
        VecX u = random_vector(sheet.b.size(), 1, 1), v = random_vector(sheet.b.size(), 1, 2), Pu = u, Pv = v;
        filter.apply(u);
        filter.apply(v);
        preconditioner->apply(u, Pu);
        preconditioner->apply(v, Pv);
        filter.apply(Pu);
        filter.apply(Pv);
        CHECK(u.dot(Pu) > 0);
        CHECK(v.dot(Pv) > 0);
        CHECK(std::abs(u.dot(Pv) - v.dot(Pu)) < 2e-5 * std::sqrt(u.dot(Pu) * v.dot(Pv)));  // floats inside
        if (first.size() == 0) first = Pu;
        CHECK(Pu == first);
      }
    }
}

TEST_CASE("a product that a preconditioner gives is that of the matrix, and costs no iteration",
          "[solvers]") {
  const ThreadsRestored restored;
  for (const int side : {12, 30, 60})
    for (const bool far : {false, true}) {
      INFO(side << (far ? ", coupled far" : ""));
      const CoupledSheet sheet(side, far);
      REQUIRE(sheet.A.overlay().empty() == !far);
      const VecX zero = VecX::Zero(3 * side * side);
      VecX r = random_vector(zero.size(), 1, 3), first;
      sheet.filter.apply(r);
      for (const int t : {1, 2, 7}) {
        set_threads(t);
        const auto multigrid = make_multigrid();
        LinearReport report;
        REQUIRE(multigrid->prepare(sheet.A, sheet.filter, report));
        VecX s = zero, alone = zero, given = zero, product = zero;
        REQUIRE(multigrid->apply_and_multiply(r, s, given));
        multigrid->apply(r, alone);
        CHECK(s == alone);
        sheet.filter.apply(s);
        sheet.A.add_overlay(s, given);
        sheet.A.multiply(s, product);
        for (VecX* v : {&given, &product}) sheet.filter.apply(*v);
        double stiffest = 0;
        for (int i = 0; i < side * side; ++i)
          stiffest = std::max(stiffest, sheet.A.at(sheet.A.pattern().diagonal(i)).norm());
        CHECK((given - product).norm() < 2e-7 * stiffest * s.norm());
        CHECK(product.norm() > 1e-4 * stiffest * s.norm());
        if (first.size() == 0) first = given;
        CHECK(given == first);
      }
      for (const double tolerance : {1e-5, 1e-7, 1e-11}) {
        VecX with = random_vector(zero.size(), 1, 4), without = with;
        const LinearOptions options{.tolerance = tolerance};
        const LinearReport quick =
            make_pcg("quick", true, make_multigrid())->solve(sheet.A, r, sheet.filter, options, with);
        const LinearReport plain = make_pcg("plain", true, std::make_unique<WithoutProduct>())
                                       ->solve(sheet.A, r, sheet.filter, options, without);
        INFO(tolerance);
        CHECK(quick.iterations <= (tolerance > 1e-6 ? 1.02 : 1.1) * plain.iterations + 1);
        CHECK(quick.reason == StopReason::converged);
        CHECK(quick.residual <= 1.01 * tolerance);
        CHECK((with - without).norm() < 10 * tolerance * without.norm());
      }
    }
}

TEST_CASE("a wrong product of a preconditioner costs iterations, not the solution", "[solvers]") {
  const CoupledSheet sheet(30, true);
  VecX b = random_vector(3 * 30 * 30, 1, 3), expected = VecX::Zero(b.size());
  make_linear_solver("eigen-ldlt")->solve(sheet.A, b, sheet.filter, {}, expected);
  for (const double factor : {-1.0, 0.0, 0.9, 1e3, std::numeric_limits<double>::quiet_NaN()})
    for (const bool prefiltered : {false, true}) {
      INFO((prefiltered ? "ppcg, " : "mpcg, ") << factor);
      VecX dv = random_vector(b.size(), 1, 4);
      const auto solver = make_pcg("pcg", prefiltered, std::make_unique<WrongProduct>(factor));
      const LinearReport report = solver->solve(sheet.A, b, sheet.filter, {.tolerance = 1e-7}, dv);
      CHECK(report.reason == StopReason::converged);
      CHECK(report.residual <= 1.01e-7);
      CHECK((dv - expected).norm() < 1e-5 * expected.norm());
    }
}

TEST_CASE("contacts that come and go need no new analysis, and every solver still agrees", "[solvers]") {
  const FallingSheet sheet(17, 15);
  for (const auto& info : linear_solvers()) {
    INFO(info.name);
    const auto solver = make_linear_solver(info.name);
    int analyses = 0;
    for (int round = 0; round < 6; ++round) {
      std::vector<int> touching;
      for (int i = round; i < 17 * 17; i += 7 + round) touching.push_back(i);
      const Filter filter = sheet.held(touching);
      VecX dv = VecX::Zero(sheet.b.size()), expected = dv;
      const LinearReport report =
          solver->solve(sheet.stepper.matrix(), sheet.b, filter, {.tolerance = 1e-9}, dv);
      make_linear_solver("eigen-ldlt")->solve(sheet.stepper.matrix(), sheet.b, filter, {}, expected);
      CHECK(report.reason == StopReason::converged);
      CHECK((dv - expected).norm() <= 1e-5 * expected.norm());
      analyses += report.analyses;
    }
    if (info.name == "cholmod" || info.name == "eigen-ldlt") CHECK(analyses == 1);
  }
}

TEST_CASE("an incomplete factor that breaks down is built safer, and says so", "[solvers]") {
  const FallingSheet sheet(33, 15);
  const auto preconditioner = make_preconditioner("block-ic0");
  LinearReport report;
  REQUIRE(preconditioner->prepare(sheet.stepper.matrix(), sheet.filter, report));
  REQUIRE(preconditioner->make_safer(sheet.stepper.matrix(), sheet.filter, report));
  CHECK(report.shift > 0);
  CHECK_THAT(remark(report), Catch::Contains("broke down"));
}

TEST_CASE("a preconditioner that fails is made safer and the solve begun again, or it is told", "[solvers]") {
  const FallingSheet sheet(17, 15);
  Filter filter = sheet.held({3, 50, 99});
  filter.constrain(120, Mat3::Zero(), Vec3(0.1, -0.2, 0.3));
  VecX expected = VecX::Zero(sheet.b.size());
  make_linear_solver("eigen-ldlt")->solve(sheet.stepper.matrix(), sheet.b, filter, {}, expected);
  for (const bool prefiltered : {false, true})
    for (const bool can_be_safer : {true, false}) {
      INFO((prefiltered ? "ppcg" : "mpcg") << (can_be_safer ? ", can be made safer" : ""));
      Failing::Told told;
      const auto solver = make_pcg("pcg", prefiltered, std::make_unique<Failing>(4, can_be_safer, told));
      VecX dv = random_vector(sheet.b.size(), 1, 4);
      const LinearReport report =
          solver->solve(sheet.stepper.matrix(), sheet.b, filter, {.tolerance = 1e-10}, dv);
      if (can_be_safer) {
        CHECK(report.reason == StopReason::converged);
        CHECK((dv - expected).norm() <= 1e-5 * expected.norm());
        CHECK(told.safer == 1);
        CHECK(told.learnt == report.iterations - 4);  // of the safer one, and what it alone reached from z on
        CHECK(told.decades == Approx(-std::log10(report.residual)).epsilon(1e-3));
        CHECK_FALSE(told.forgotten);
      } else {
        CHECK(report.reason == StopReason::indefinite);
        CHECK(told.forgotten);  // so that one that is kept is not kept for the next system
      }
    }
}
