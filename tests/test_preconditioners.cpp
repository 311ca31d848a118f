// Laws of the preconditioners, and of solvers that keep something from one system to the next.
#include <catch2/catch.hpp>

#include "mesh/base/threads.h"
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

const std::vector<std::string> names = {"block-jacobi", "block-ic0", "multigrid"};

}  // namespace

TEST_CASE("a preconditioner is symmetric and positive definite, the same bits on any number of threads",
          "[solvers]") {
  const FallingSheet sheet(60, 12);  // large enough for threads
  const Filter filter = sheet.held({0, 59, 700, 701, 702, 1800, 1801, 1900, 2500});
  const ThreadsRestored restored;
  for (const std::string& name : names) {
    INFO(name);
    VecX first;
    for (int t : {1, 2, 7}) {
      set_threads(t);
      const auto preconditioner = make_preconditioner(name);
      LinearReport report;
      REQUIRE(preconditioner->prepare(sheet.stepper.matrix(), filter, report));
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
