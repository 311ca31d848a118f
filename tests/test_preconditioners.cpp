// Laws of the preconditioners, and of solvers that keep something from one system to the next.
#include <catch2/catch.hpp>

#include "app/compare/recording_solver.h"
#include "mesh/threads.h"
#include "solver/linear/pcg.h"
#include "solver/linear/smoother.h"
#include "tests/allocations.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

// A hung sheet after some steps: the matrix of a real fall, slack and taut edges in it.
struct FallingSheet : HungSheet {
  Recording recording;
  ImplicitEuler stepper;
  Filter filter;
  VecX b, guess;

  FallingSheet(int side, int steps, double stretch = 2000)
      : HungSheet(side, stretch, 1e-5),
        stepper(system, constraints, std::make_unique<RecordingSolver>(make_linear_solver("mpcg"), recording),
                {.tolerance = 1e-3}) {
    for (int k = 0; k < steps; ++k) {
      recording.on = k + 1 == steps;
      stepper.advance(state, 0.01);
    }
    b = recording.last->b;
    guess = recording.last->guess;
    filter = held({0, side - 1});
  }

  // Locks some particles, and lets every third one of them slide.
  Filter held(const std::vector<int>& particles) const {
    Filter f;
    int count = 0;
    for (int i : particles) {
      const Vec3 n = Vec3(0.3, 1, -0.2).normalized();
      const Mat3 S = ++count % 3 == 0 ? Mat3(Mat3::Identity() - n * n.transpose()) : Mat3(Mat3::Zero());
      f.constrain(i, S, Vec3::Zero());
    }
    f.renumber(stepper.matrix().pattern().row_of());
    return f;
  }
};

// Block-jacobi that after some iterations acts as a negative definite matrix, until it is made safer, if it
// can be.
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

std::vector<int> iterations_of(const FallingSheet& sheet, double tolerance) {
  std::vector<int> iterations;
  for (const char* name : {"ppcg", "ppcg+block-ic0", "ppcg+multigrid"}) {
    VecX dv = sheet.guess;
    const LinearReport report = make_linear_solver(name)->solve(sheet.stepper.matrix(), sheet.b, sheet.filter,
                                                                {.tolerance = tolerance}, dv);
    INFO(name << ", " << sheet.state.particles() << " vertices: " << report.note);
    CHECK(report.reason == StopReason::converged);
    iterations.push_back(report.iterations);
  }
  return iterations;
}

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

TEST_CASE("better preconditioners need fewer iterations, multigrid as few on a finer or stiffer sheet",
          "[solvers]") {
  std::vector<int> by_multigrid;  // the last is as stiff for its mass as a sheet of half a million vertices
  for (const auto& [side, stretch] : {std::pair{33, 2e3}, {65, 2e3}, {150, 2e3}, {150, 5e4}}) {
    const FallingSheet sheet(side, 6, stretch);
    const std::vector<int> iterations = iterations_of(sheet, 1e-3);
    CHECK(2 * iterations[1] < iterations[0]);
    CHECK(iterations[2] < iterations[1]);
    by_multigrid.push_back(iterations[2]);
    CHECK(by_multigrid.back() <= by_multigrid.front() + 4);
  }
}

TEST_CASE("multigrid bears a stiffness that is millions of times the mass", "[solvers]") {
  for (double stretch : {2e4, 2e5, 2e6}) {
    const std::vector<int> iterations = iterations_of(FallingSheet(65, 5, stretch), 1e-6);
    CHECK(3 * iterations[2] < iterations[0]);
  }
}

TEST_CASE("what floats lose of a row's sum stands in the smoother's diagonal", "[solvers]") {
  const FallingSheet sheet(33, 5, 2e6);
  const BlockMatrix& A = sheet.stepper.matrix();
  const Filter none;
  const ProjectedBlocks blocks(A, none);
  const Mirror below = below_diagonal(A.pattern());
  const ProjectedRows rows(A, blocks, below);
  Smoother smoother;
  smoother.build(rows);
  double worst = 0, lost = 0;
  for (int r = 0; r < A.rows(); ++r) {
    Mat3 exact = Mat3::Zero(), kept = exact, floats = exact;
    rows.each(r, [&](int c, const Mat3& block) {
      exact += block;
      floats += c == r ? block : Mat3(block.cast<float>().cast<double>());
    });
    smoother.each(r, [&](int, const auto* block) {
      using Scalar = std::remove_cvref_t<decltype(*block)>;
      kept += Eigen::Map<const Eigen::Matrix<Scalar, 3, 3>>(block).template cast<double>();
    });
    const double size = A.at(A.pattern().diagonal(r)).norm();
    worst = std::max(worst, (kept - exact).norm() / size);
    lost = std::max(lost, (floats - exact).norm() / size);
  }
  CHECK(worst < 1e-14);
  CHECK(lost > 1e-9);  // there is something to lose
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

TEST_CASE("a kept hierarchy knows what is held now", "[solvers]") {
  const FallingSheet sheet(33, 15);
  const BlockMatrix& A = sheet.stepper.matrix();
  const auto multigrid = make_preconditioner("multigrid");
  LinearReport report;
  REQUIRE(multigrid->prepare(A, sheet.held({0, 32}), report));
  CHECK(report.analyses == 1);
  const Filter now = sheet.held({5, 300, 301, 555, 800});
  report = {};
  REQUIRE(multigrid->prepare(A, now, report));
  CHECK(report.analyses == 0);  // kept
  const VecX r = random_vector(sheet.b.size(), 1, 8);
  VecX s = r;
  multigrid->apply(r, s);
  int locked = 0;
  for (const FilterEntry& e : now.entries()) {  // a row of the identity, where S A S + I - S is that
    if (!e.S.isZero(0)) continue;
    ++locked;
    CHECK((s.segment<3>(3 * e.particle) - r.segment<3>(3 * e.particle)).norm() < 1e-12);
  }
  CHECK(locked == 4);
}

TEST_CASE("a hierarchy is judged by what it took when new for a decade or more, and by nothing less",
          "[solvers]") {
  const FallingSheet sheet(33, 15);
  const auto multigrid = make_preconditioner("multigrid");
  const auto analyses = [&] {
    LinearReport report;
    REQUIRE(multigrid->prepare(sheet.stepper.matrix(), sheet.filter, report));
    return report.analyses;
  };
  CHECK(analyses() == 1);
  CHECK_FALSE(multigrid->outdated(1000, 1));  // nothing is newer than new
  multigrid->learn(1, 0.9);                   // by luck, or from a good guess: says nothing
  CHECK(analyses() == 0);
  CHECK_FALSE(multigrid->outdated(100, 6));
  multigrid->learn(30, 6);  // the first that says something
  CHECK(analyses() == 0);
  CHECK_FALSE(multigrid->outdated(44, 6));  // a third, and four, more
  CHECK(multigrid->outdated(45, 6));
  CHECK_FALSE(multigrid->outdated(10, 0.1));  // less than a decade counts as one
  CHECK(multigrid->outdated(11, 0.1));
  multigrid->learn(40, 6);  // slower, and not the new measure
  CHECK(analyses() == 0);
  CHECK(multigrid->outdated(45, 6));
  multigrid->learn(45, 6);
  CHECK(analyses() == 1);  // built anew, and measured anew
  multigrid->learn(60, 6);
  CHECK(analyses() == 0);
  CHECK_FALSE(multigrid->outdated(84, 6));
  CHECK(multigrid->outdated(85, 6));
}

TEST_CASE("one system over and over needs one analysis, wherever the iteration begins", "[solvers]") {
  const FallingSheet sheet(65, 6);
  const auto solver = make_linear_solver("ppcg+multigrid");
  int analyses = 0;
  const auto solve = [&](VecX dv, double tolerance) {
    const LinearReport report =
        solver->solve(sheet.stepper.matrix(), sheet.b, sheet.filter, {.tolerance = tolerance}, dv);
    CHECK(report.reason == StopReason::converged);
    analyses += report.analyses;
    return report.iterations;
  };
  VecX solution = sheet.guess;
  make_linear_solver("eigen-ldlt")->solve(sheet.stepper.matrix(), sheet.b, sheet.filter, {}, solution);
  CHECK(solve(solution, 1e-3) == 0);
  for (const double nearly : {1e-2, 5e-3, 3e-3}) {
    VecX dv = sheet.guess;
    make_linear_solver("ppcg+multigrid")
        ->solve(sheet.stepper.matrix(), sheet.b, sheet.filter, {.tolerance = nearly}, dv);
    CHECK(solve(dv, 0.5 * nearly) <= 3);  // less than a decade
  }
  for (const double tolerance : {1e-8, 1e-3, 1e-6}) CHECK(solve(sheet.guess, tolerance) > 3);
  CHECK(analyses == 1);
}

TEST_CASE("of a set-up that threw nothing is used", "[solvers]") {
  if (!counts_allocations()) return;  // with the sanitizers none can be made to fail
  const ThreadsRestored restored;
  set_threads(1);
  const FallingSheet sheet(33, 15);
  const BlockMatrix& A = sheet.stepper.matrix();
  const VecX r = random_vector(sheet.b.size(), 1, 8);
  VecX expected = r, s = r;
  LinearReport report;
  const auto fresh = make_preconditioner("multigrid");
  REQUIRE(fresh->prepare(A, sheet.filter, report));
  fresh->apply(r, expected);
  for (const bool kept : {true, false}) {  // the hierarchy from before is used again, or built
    int thrown = 0;
    for (long after = 0; after < 5000; after = after < 20 ? after + 1 : 2 * after) {
      INFO("allocation " << after << (kept ? " of a kept one" : " of a new one"));
      const auto multigrid = make_preconditioner("multigrid");
      if (kept) REQUIRE(multigrid->prepare(A, sheet.held({7, 8, 9}), report));
      bool threw = false;
      fail_allocation(after);
      try {
        multigrid->prepare(A, sheet.filter, report);
      } catch (const std::bad_alloc&) {
        threw = true;
      }
      const bool failed = fail_allocation(-1);
      CHECK(threw == failed);
      if (!threw) break;
      ++thrown;
      report = {};
      REQUIRE(multigrid->prepare(A, sheet.filter, report));
      CHECK(report.analyses == 1);
      multigrid->apply(r, s);
      CHECK(s == expected);
    }
    CHECK(thrown > (kept ? 0 : 20));
  }
}

TEST_CASE("an incomplete factor that breaks down is built safer, and says so", "[solvers]") {
  const FallingSheet sheet(33, 15);
  const auto preconditioner = make_preconditioner("block-ic0");
  LinearReport report;
  REQUIRE(preconditioner->prepare(sheet.stepper.matrix(), sheet.filter, report));
  REQUIRE(preconditioner->make_safer(sheet.stepper.matrix(), sheet.filter, report));
  CHECK_THAT(report.note, Catch::Contains("broke down"));
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
