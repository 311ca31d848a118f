// Laws of the multigrid preconditioner: iterations on fine and stiff sheets,
// what it keeps, what it leaves behind.
#include <catch2/catch.hpp>

#include "mesh/base/threads.h"
#include "solver/linear/preconditioner.h"
#include "solver/linear/smoother.h"
#include "tests/allocations.h"
#include "tests/falling_sheet.h"

using namespace drape;
using namespace drape::app;
using namespace drape::internal;
using namespace drape::test;

namespace {

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
  std::vector<int> entry_of_row;
  const ProjectedBlocks blocks(A, none, entry_of_row);
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
    CHECK((kept ? thrown == 0 : thrown > 20));  // to use a kept one allocates nothing
  }
}
