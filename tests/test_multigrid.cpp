// Laws of the multigrid preconditioner: iterations on fine and stiff sheets,
// what it keeps, what it leaves behind.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "mesh/base/threads.h"
#include "solver/linear/aggregation.h"
#include "solver/linear/galerkin.h"
#include "solver/linear/preconditioner.h"
#include "solver/linear/row_sum.h"
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

// The finest level of a sheet in which some particles are held.
struct ProjectedSheet {
  Filter filter;
  std::vector<int> entry_of_row;
  ProjectedBlocks blocks;
  Smoother smoother;

  ProjectedSheet(const FallingSheet& sheet, Filter held)
      : filter(std::move(held)), blocks(sheet.stepper.matrix(), filter, entry_of_row) {
    const BlockMatrix& A = sheet.stepper.matrix();
    const Mirror below = below_diagonal(A.pattern());
    smoother.build(ProjectedRows(A, blocks, below));
  }
};

// What is made of it for the next level.
struct Coarser {
  Aggregation aggregation;
  BlockRows P, R;
  Galerkin galerkin;
  const SymmetricRows* coarse = nullptr;  // of the Galerkin
  int columns = 0;

  void make(const ProjectedSheet& fine) {
    columns = aggregation.make_prolongation(fine.smoother, 0.02, &fine.blocks, P);
    transpose(P, columns, R);
    coarse = &galerkin.coarse(fine.smoother, P, R);
  }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * columns, 3 * columns);
    for (int r = 0; r < columns; ++r)
      coarse->each(r, [&](int c, const float* block, bool turned) {
        const Eigen::Map<const Eigen::Matrix3f> b(block);
        A.block<3, 3>(3 * r, 3 * c) =
            (turned ? Eigen::Matrix3f(b.transpose()) : Eigen::Matrix3f(b)).cast<double>();
      });
    return A;
  }
};

Eigen::MatrixXd dense(const BlockRows& rows, int columns) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * rows.rows(), 3 * columns);
  for (int r = 0; r < rows.rows(); ++r)
    for (int k = 0; k < rows[r].count; ++k)
      A.block<3, 3>(3 * r, 3 * rows[r].column[k]) =
          Eigen::Map<const Eigen::Matrix3f>(rows[r][k]).cast<double>();
  return A;
}
Eigen::MatrixXd dense(const Smoother& rows) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * rows.rows(), 3 * rows.rows());
  for (int r = 0; r < rows.rows(); ++r)
    rows.each(r, [&](int c, const auto* block) {
      using Scalar = std::remove_cvref_t<decltype(*block)>;
      A.block<3, 3>(3 * r, 3 * c) =
          Eigen::Map<const Eigen::Matrix<Scalar, 3, 3>>(block).template cast<double>();
    });
  return A;
}

}  // namespace

TEST_CASE("better preconditioners need fewer iterations, multigrid hardly more on a finer or stiffer sheet",
          "[solvers]") {
  std::vector<int> by_multigrid;  // the last is as stiff for its mass as a sheet of half a million vertices
  for (const auto& [side, stretch] : {std::pair{33, 2e3}, {65, 2e3}, {150, 2e3}, {150, 5e4}}) {
    const FallingSheet sheet(side, 5, stretch);
    const std::vector<int> iterations = iterations_of(sheet, 1e-3);
    CHECK(2 * iterations[1] < iterations[0]);
    CHECK(iterations[2] < iterations[1]);
    by_multigrid.push_back(iterations[2]);
    CHECK(by_multigrid.back() <= 2 * by_multigrid.front());
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
    rows.each(r, [&](int c, const double* stored, bool turned) {
      const Eigen::Map<const Mat3> as_stored(stored);
      const Mat3 block = turned ? Mat3(as_stored.transpose()) : Mat3(as_stored);
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

TEST_CASE(
    "the smoother holds the projected matrix, turned blocks of sliding particles too, and no zero block",
    "[solvers]") {
  const FallingSheet sheet(17, 15);
  const ProjectedSheet projected(sheet, sheet.held({20, 21, 22, 37, 38, 39, 150, 151, 152}));
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(sheet.b.size(), sheet.b.size());
  for (const FilterEntry& e : projected.filter.entries()) S.block<3, 3>(3 * e.particle, 3 * e.particle) = e.S;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(S.rows(), S.cols());
  const BlockMatrix& matrix = sheet.stepper.matrix();
  int zero = 0, blocks = 0;
  for (int r = 0; r < matrix.rows(); ++r)
    matrix.each(r, [&](int c, int slot) {
      A.block<3, 3>(3 * r, 3 * c) = matrix.at(slot);
      A.block<3, 3>(3 * c, 3 * r) = matrix.at(slot).transpose();
    });
  const Eigen::MatrixXd expected = S * A * S + Eigen::MatrixXd::Identity(S.rows(), S.cols()) - S;
  const Eigen::MatrixXd held = dense(projected.smoother);
  CHECK((held - expected).norm() < 1e-6 * expected.norm());
  CHECK((held - held.transpose()).norm() < 1e-15 * held.norm());
  for (int r = 0; r < matrix.rows(); ++r)
    projected.smoother.each_other(r, [&](int, const float* block) {
      ++blocks;
      zero += Eigen::Map<const Eigen::Matrix3f>(block).isZero(0);
    });
  CHECK(zero == 0);
  CHECK(blocks < 2 * (matrix.pattern().blocks() - matrix.rows()));  // there are slack springs
}

TEST_CASE("sweeps are Gauss-Seidel's, down and up, and tell the residual and the product that they leave",
          "[solvers]") {
  for (const int side : {13, 33}) {  // one chunk of rows, and several
    const FallingSheet sheet(side, 15);
    const ProjectedSheet projected(sheet, sheet.held({0, 20, 21, 22, 150}));
    const Smoother& smoother = projected.smoother;
    const Eigen::MatrixXd A = dense(smoother);
    const VecX r = random_vector(A.rows(), 1, 2);
    const VecX unset = VecX::Constant(r.size(), std::numeric_limits<double>::quiet_NaN());
    VecX x = VecX::Zero(r.size()), change = unset, left = unset, from_zero = unset;
    smoother.sweep(r, x, change);
    smoother.sweep_from_zero(r, from_zero, change = unset, left);
    CHECK(from_zero == x);
    CHECK((left - (r - A * x)).norm() < 1e-12 * r.norm());
    CHECK(left.norm() > 1e-3 * r.norm());
    VecX again = x, Ax = unset;
    smoother.sweep(r, x, change);
    smoother.sweep(r, again, change = unset, Ax);
    CHECK(again == x);
    CHECK((Ax - A * x).norm() < 1e-12 * Ax.norm());
    std::vector<int> order;  // even chunks of 256 rows, then odd ones
    for (const int odd : {0, 1})
      for (int i = 0; i < smoother.rows(); ++i)
        if (i / 256 % 2 == odd) order.push_back(i);
    VecX expected = VecX::Zero(r.size());
    const auto solve_row = [&](int i) {
      const Vec3 rest = r.segment<3>(3 * i) - A.middleRows<3>(3 * i) * expected +
                        A.block<3, 3>(3 * i, 3 * i) * expected.segment<3>(3 * i);
      expected.segment<3>(3 * i) = A.block<3, 3>(3 * i, 3 * i).inverse() * rest;
    };
    for (int time = 0; time < 2; ++time) {
      std::for_each(order.begin(), order.end(), solve_row);
      std::for_each(order.rbegin(), order.rend(), solve_row);
    }
    CHECK((x - expected).norm() < 1e-10 * expected.norm());
  }
}

TEST_CASE("the next coarser matrix is P^T A P, symmetric to the last bit", "[solvers]") {
  const FallingSheet sheet(33, 15);
  const ProjectedSheet fine(sheet, sheet.held({0, 32, 300, 301, 302, 555}));
  Coarser coarser;
  coarser.make(fine);
  const Eigen::MatrixXd P = dense(coarser.P, coarser.columns), R = dense(coarser.R, fine.smoother.rows());
  CHECK(R == P.transpose());
  const Eigen::MatrixXd A = coarser.matrix(), expected = R * dense(fine.smoother) * P;
  CHECK(A == A.transpose());
  CHECK((A - expected).norm() < 1e-6 * expected.norm());
  CHECK(coarser.columns < fine.smoother.rows() / 3);
}

TEST_CASE("what makes levels gives the same bits after larger and smaller sheets as when it is new",
          "[solvers]") {
  const FallingSheet small(17, 15), large(40, 12);
  Coarser kept;
  for (const FallingSheet* sheet : {&small, &large, &small, &large}) {
    const ProjectedSheet fine(*sheet, sheet->held({3, 50, 99}));
    Coarser fresh;
    fresh.make(fine);
    kept.make(fine);
    CHECK(kept.columns == fresh.columns);
    CHECK(dense(kept.P, kept.columns) == dense(fresh.P, fresh.columns));
    CHECK(kept.matrix() == fresh.matrix());
  }
}

TEST_CASE("a sum of a row that was left in the middle leaves nothing to the next", "[solvers]") {
  const std::vector<float> one(10, 1);
  for (int time = 0; time < 2; ++time) {
    RowSum sum(1000);
    for (const int column : {7, 999, 7, 3}) sum.at(column).add(one.data());
    for (int column = 100; column < 180; ++column) sum.at(column).add(one.data());
    if (time == 0) continue;  // never taken
    std::vector<int> columns;
    sum.take([&](int column, const WideBlock& block) {
      columns.push_back(column);
      CHECK(block.column[2][2] == (column == 7 ? 2 : 1));
    });
    CHECK(columns.size() == 83);
    CHECK(std::vector<int>(columns.begin(), columns.begin() + 3) == std::vector<int>{7, 999, 3});
    sum.take([&](int, const WideBlock&) { FAIL("the row is empty"); });
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
    CHECK((kept ? thrown == 0 : thrown > 20));  // to use a kept one allocates nothing
  }
}
