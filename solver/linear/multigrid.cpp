// A V-cycle of smoothed aggregation as preconditioner.
//                                      [Vanek, Mandel & Brezina 1996; Tamstorf, Jones & McCormick 2015]
//   level: x = sweep (r);  x += P V(P^T (r - A x));  x = sweep (r, x);    next level: A_c = P^T A P
// A sweep is Gauss-Seidel's, down and up (smoother.h).
// It is our own because it was faster than PETSc's GAMG on these matrices (tests/bench measures both): it has
// blocks of whole vertices, kept in float, and threads that do not change a bit of the result. The finest
// level is made for every system, because it contains what is held. The coarser levels are new for every
// matrix that is assembled: a step makes a tenth of the couplings ten times stiffer or softer, and old levels
// took up to twice the iterations. Among the systems of one matrix they are kept while they work well enough:
// that is while a solve takes at most 4/3 n + 4 iterations, where n iterations gave the same number of
// decades of the residual (at least one) when the levels were new. When they no longer do, even in the middle
// of a solve, they are built anew.
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "solver/linear/aggregation.h"
#include "solver/linear/galerkin.h"
#include "solver/linear/preconditioner.h"

namespace drape::internal {
namespace {

// A threshold above a few percent cuts couplings that the finest sheets need: 0.08 took 65 iterations where
// 0.02 took 12 (100,000 vertices, tolerance 1e-3).
constexpr double strength = 0.02;
constexpr int coarsest_rows = 50, most_levels = 12;
// Levels that took more iterations than this even when new are not kept for the next system.
constexpr int most_iterations = 1000;

struct Level {
  Smoother smoother;
  Aggregation aggregation;
  BlockRows prolongation, restriction;  // to the next coarser level
  VecX x, r, residual, change;          // x and r belong to the system of a coarser level

  template <class Rows>
  void build(const Rows& A) {
    smoother.build(A);
    for (VecX* v : {&x, &r, &residual, &change}) v->setZero(3 * static_cast<Eigen::Index>(A.rows()));
  }
};

class Multigrid final : public Preconditioner {
 public:
  std::string_view name() const override { return "multigrid"; }

  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    fallen_back_ = false;
    reused_ = works_ && count_ > 1 && fill_ == A.fill();
    fill_ = A.fill();
    works_ = false;  // until the levels are built
    const ProjectedBlocks projected(A, filter, entry_of_row_);
    for (int r = 0; r < A.rows(); ++r)
      if (!positive_definite(projected.block(A.pattern().diagonal(r), r, r))) return false;
    if (serial_ != A.pattern().serial()) below_ = below_diagonal(A.pattern());
    serial_ = A.pattern().serial();
    const ProjectedRows rows(A, projected, below_);
    if (reused_) {
      levels_.front().smoother.build(rows);
    } else {
      ++report.analyses;
      if (!build(rows, projected)) return false;
    }
    works_ = true;
    return true;
  }

  // Kept levels may be too old for this matrix, so new ones are built first; where new ones fail,
  // block-Jacobi takes over.
  bool make_safer(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    if (fallen_back_) return false;
    works_ = false;
    if (reused_) return prepare(A, filter, report);
    fallen_back_ = true;
    report.note = "multigrid did not act as a positive definite matrix; block-jacobi took over";
    return block_jacobi_->prepare(A, filter, report);
  }

  void apply(const VecX& r, VecX& s) override {
    if (fallen_back_) return block_jacobi_->apply(r, s);
    cycle(0, r, s);
  }

  bool apply_and_multiply(const VecX& r, VecX& s, VecX& Bs) override {
    if (fallen_back_ || count_ == 1) return Preconditioner::apply_and_multiply(r, s, Bs);
    correct(0, r, s);
    levels_.front().smoother.sweep(r, s, levels_.front().change, Bs);
    return true;
  }

  bool outdated(int iterations, double decades) const override {
    return reused_ && !fallen_back_ && rate_when_new_ &&
           3 * iterations > 4 * *rate_when_new_ * std::max(decades, 1.0) + 12;
  }

  void learn(int iterations, double decades) override {
    if (outdated(iterations, decades) || iterations > most_iterations) works_ = false;
    if (!reused_) rate_when_new_.reset();
    if (!rate_when_new_ && decades >= 1) rate_when_new_ = iterations / decades;
  }

  void forget() override { works_ = false; }

 private:
  // Returns false when A is not positive definite.
  bool build(const ProjectedRows& A, const ProjectedBlocks& projected) {
    count_ = 0;
    add_level(A);
    while (last().smoother.rows() > coarsest_rows && count_ < most_levels) {
      Level& fine = last();
      const int columns = fine.aggregation.make_prolongation(
          fine.smoother, strength, count_ == 1 ? &projected : nullptr, fine.prolongation);
      if (columns == 0 || 10 * columns > 9 * fine.smoother.rows()) break;  // coarser gains nothing
      transpose(fine.prolongation, columns, fine.restriction);
      add_level(galerkin_.coarse(fine.smoother, fine.prolongation, fine.restriction));
    }
    // A coarser matrix that is not positive definite says nothing about A: rounding to float may have caused
    // it.
    return factorise(last().smoother) || count_ > 1;
  }

  Level& last() { return levels_[count_ - 1]; }
  template <class Rows>
  void add_level(const Rows& A) {
    ++count_;
    last().build(A);
  }

  bool factorise(const Smoother& A) {
    coarse_.reset();
    if (A.rows() > 8 * coarsest_rows) return true;  // too large for a dense factor, so it is only smoothed
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * A.rows(), 3 * A.rows());
    for (int r = 0; r < A.rows(); ++r)
      A.each(r, [&](int c, const auto* block) {
        for (int e = 0; e < 9; ++e) dense(3 * r + e % 3, 3 * c + e / 3) = block[e];
      });
    coarse_.emplace(dense);
    if (coarse_->info() == Eigen::Success) return true;
    coarse_.reset();
    return false;
  }

  void cycle(int depth, const VecX& r, VecX& x) {
    if (depth + 1 == count_ && coarse_) {
      x = coarse_->solve(r);
    } else {
      correct(depth, r, x);
      levels_[depth].smoother.sweep(r, x, levels_[depth].change);
    }
  }

  // All of a cycle but the sweep after the coarser levels.
  void correct(int depth, const VecX& r, VecX& x) {
    Level& level = levels_[depth];
    level.smoother.sweep_from_zero(r, x, level.change, level.residual);
    if (depth + 1 == count_) return;
    Level& below = levels_[depth + 1];
    for_chunks<Work::heavy>(below.smoother.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Four sum = times(level.restriction[i], level.residual.data());
        for (int k = 0; k < 3; ++k) below.r[3 * i + k] = sum[k];
      }
    });
    cycle(depth + 1, below.r, below.x);
    for_chunks<Work::heavy>(level.smoother.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Four correction = times(level.prolongation[i], below.x.data());
        for (int k = 0; k < 3; ++k) x[3 * i + k] += correction[k];
      }
    });
  }

  std::array<Level, most_levels> levels_;  // the first count_ are in use
  int count_ = 0;
  std::vector<int> entry_of_row_;  // scratch of ProjectedBlocks
  Galerkin galerkin_;
  Mirror below_;                                       // of the pattern
  std::optional<Eigen::LLT<Eigen::MatrixXd>> coarse_;  // of the last level; empty: that is only smoothed
  std::uint64_t serial_ = 0, fill_ = 0;
  bool works_ = false, reused_ = false, fallen_back_ = false;
  std::unique_ptr<Preconditioner> block_jacobi_ = make_block_jacobi();
  std::optional<double> rate_when_new_;  // iterations a decade; unknown before a solve of at least one
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid() { return std::make_unique<Multigrid>(); }

}  // namespace drape::internal
