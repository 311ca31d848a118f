// A V-cycle of smoothed aggregation as preconditioner.     [Vanek, Mandel & Brezina 1996; Tamstorf, Jones &
// McCormick 2015]
//   level: x = smooth down (r);  x += P V(P^T (r - A x));  x = smooth up (r, x);    next level: A_c = P^T A P
// Our own, because it beat PETSc's GAMG on these matrices (tests/bench measures both): blocks of whole
// vertices, float inside the cycle, and threads that do not change a bit. The hierarchy is kept from step to
// step while it still works: while the iterations stay within a third more than when it was new. Once they do
// not, even in the middle of a solve, it is built anew. (Waiting longer, for as many iterations as a set-up
// takes time, was slower in every gallery scene.)
#include <Eigen/Cholesky>
#include <optional>

#include "solver/linear/aggregation.h"
#include "solver/linear/preconditioner.h"
#include "solver/linear/projected_block.h"
#include "solver/linear/smoother.h"

namespace drape {
namespace {

constexpr double strength = 0.08;  // of the finest level, half of it on each coarser one
constexpr int coarsest_rows = 50, most_levels = 12;
constexpr int most_iterations = 1000;  // more than that with a new one: the next system gets another chance

struct Level {
  Smoother smoother;
  FloatCsr prolongation, restriction;  // rows and columns as the smoothers number them
  VecXf x, r, residual;

  explicit Level(const BlockCsr& A) : smoother(A), x(VecXf::Zero(3 * A.rows())), r(x), residual(x) {}
};

// Directions that no vertex of an aggregate may take have no stiffness: they get a little, and stay at zero.
void make_definite(BlockCsr& A) {
  for (int r = 0; r < A.rows(); ++r)
    for (int k = A.begin(r); k < A.end(r); ++k)
      if (A.at(k) == r) {
        Mat3& block = A.block[static_cast<std::size_t>(k)];
        block.diagonal().array() += block.trace() > 0 ? 1e-6 * block.trace() : 1.0;
      }
}

class Multigrid final : public Preconditioner {
 public:
  std::string_view name() const override { return "multigrid"; }

  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    fallen_back_ = false;
    reused_ = works_ && serial_ == A.pattern().serial();
    if (reused_) return true;
    const ProjectedBlocks projected(A, filter);
    for (int r = 0; r < A.rows(); ++r)
      if (!positive_definite(projected.block(A.pattern().diagonal(r), r, r))) return false;
    build(whole(A, projected), [&](int r) { return projected.S(r); });
    serial_ = A.pattern().serial();
    ++report.analyses;
    works_ = !coarse_ || coarse_->info() == Eigen::Success;
    return works_;
  }

  // Half slack, half taut, a large sheet can be too much for floats: a new hierarchy, then none.
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
    Level& top = levels_.front();
    const double size = r.cwiseAbs().maxCoeff();  // so that floats neither vanish nor overflow
    if (size == 0) return s.setZero(), void();
    for_chunks(top.smoother.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const int old = top.smoother.old_of(i);
        for (int k = 0; k < 3; ++k) top.r[3 * i + k] = static_cast<float>(r[3 * old + k] / size);
      }
    });
    cycle(0);
    for_chunks(top.smoother.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const int old = top.smoother.old_of(i);
        for (int k = 0; k < 3; ++k) s[3 * old + k] = size * static_cast<double>(top.x[3 * i + k]);
      }
    });
  }

  bool outdated(int iterations) const override {
    return reused_ && !fallen_back_ && 3 * iterations > 4 * iterations_when_new_ + 6;
  }

  void learn(int iterations) override {
    if (outdated(iterations) || iterations > most_iterations) works_ = false;
    if (!reused_) iterations_when_new_ = iterations;
  }

 private:
  void build(BlockCsr A, const std::function<Mat3(int)>& allowed) {
    levels_.clear();
    double theta = strength;
    std::function<Mat3(int)> tentative = allowed;
    levels_.emplace_back(A);
    while (A.rows() > coarsest_rows && static_cast<int>(levels_.size()) < most_levels) {
      const BlockCsr P = smoothed_aggregation(A, theta, tentative);
      if (P.columns == 0 || 10 * P.columns > 9 * A.rows()) break;  // nothing gained by a coarser one
      const BlockCsr R = transposed(P);
      A = multiply(R, multiply(A, P));
      make_definite(A);
      levels_.emplace_back(A);
      link(levels_[levels_.size() - 2], levels_.back().smoother, P, R);
      tentative = [](int) { return Mat3(Mat3::Identity()); };
      theta *= 0.5;
    }
    factorise(A);
  }

  static void link(Level& fine, const Smoother& coarse, const BlockCsr& P, const BlockCsr& R) {
    const auto all = [](int, int) { return true; };
    const auto fine_row = [&](int r) { return fine.smoother.old_of(r); };
    const auto coarse_row = [&](int r) { return coarse.old_of(r); };
    fine.prolongation = FloatCsr(
        P, fine_row, [&](int c) { return coarse.new_of(c); }, all);
    fine.restriction = FloatCsr(
        R, coarse_row, [&](int c) { return fine.smoother.new_of(c); }, all);
  }

  void factorise(const BlockCsr& A) {
    const Level& last = levels_.back();
    coarse_.reset();
    if (A.rows() > 8 * coarsest_rows) return;  // too large for a dense factor: smoothed only
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * A.rows(), 3 * A.rows());
    for (int r = 0; r < A.rows(); ++r)
      for (int k = A.begin(r); k < A.end(r); ++k)
        dense.block<3, 3>(3 * last.smoother.new_of(r), 3 * last.smoother.new_of(A.at(k))) = A[k];
    coarse_.emplace(dense);
  }

  void cycle(std::size_t depth) {
    Level& level = levels_[depth];
    if (depth + 1 == levels_.size()) {
      if (coarse_) {
        level.x = coarse_->solve(level.r.cast<double>()).cast<float>();
      } else {
        level.smoother.down(level.r, level.x, level.residual);
        level.smoother.up(level.r, level.x);
      }
      return;
    }
    Level& below = levels_[depth + 1];
    level.smoother.down(level.r, level.x, level.residual);
    for_chunks(below.smoother.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) store(level.restriction.times(i, level.residual.data()), i, below.r);
    });
    cycle(depth + 1);
    for_chunks(level.smoother.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const FourFloats c = level.prolongation.times(i, below.x.data());
        for (int k = 0; k < 3; ++k) level.x[3 * i + k] += c[k];
      }
    });
    level.smoother.up(level.r, level.x);
  }

  static void store(const FourFloats& value, int row, VecXf& to) {
    for (int k = 0; k < 3; ++k) to[3 * row + k] = value[k];
  }

  std::vector<Level> levels_;
  std::optional<Eigen::LLT<Eigen::MatrixXd>> coarse_;  // of the last level; none: smoothed only
  std::uint64_t serial_ = 0;
  bool works_ = false, reused_ = false, fallen_back_ = false;
  std::unique_ptr<Preconditioner> block_jacobi_ = make_block_jacobi();
  int iterations_when_new_ = 0;
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid() { return std::make_unique<Multigrid>(); }

}  // namespace drape
