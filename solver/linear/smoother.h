// A matrix of a multigrid level in the three parts of Gauss-Seidel's method, A = L + D + U, and its symmetric
// sweeps by blocks: one down, and one up after it.                          [Briggs, Henson & McCormick 2000]
//   down:  (L + D) y = r - U x;      up:  (D + U) x_new = r - L y
// The sweep up goes over U alone, because the sweep down has r - L y already [Conrad & Wallach 1979]. And
// what is left needs no whole product with A: A x_new = r + L (x_new - y), the residual is -L (x_new - y).
//                                                                                            [Eisenstat 1981]
// From x = 0, where U x is zero, the sweeps and the residual together read one and a half times the blocks of
// the matrix. From another x the sweeps alone read as many, and with the product it is twice the blocks.
// Rows are cut into chunks of a power of two rows, at least as many as the bandwidth. All even chunks come
// before all odd ones, and that order says what is L and what is U. Two chunks of one kind have no coupling,
// so they are swept in parallel, and the sweep up is the adjoint of the sweep down, so that both together are
// symmetric, whatever the number of threads.
// L and U are kept in float. What the rounding takes from the sum of a row is added to D, which is kept in
// double: the mass of a vertex of a fine sheet is a millionth of its stiffness, and would be lost in float.
// (This matters on the finest level only: coarser matrices come in float, and have more mass.)
// Blocks that are exactly zero are left out: where springs are slack, 25 to 40 % of the finest level's.
#pragma once

#include <Eigen/LU>
#include <algorithm>

#include "solver/linear/projected_block.h"
#include "solver/linear/sparse_rows.h"
#include "solver/linear/wide_block.h"

namespace drape::internal {

class Smoother {
 public:
  // Rows has rows(), bandwidth() and each(row, f(column, block, turned)) with both halves. Where `turned` the
  // entry of the matrix is the transpose of the block.
  template <class Rows>
  void build(const Rows& A);

  int rows() const { return rows_; }
  const double* diagonal(int row) const { return diagonal_.data() + 9 * static_cast<std::ptrdiff_t>(row); }
  template <class F>  // f(column, block)
  void each(int row, const F& f) const {
    f(row, diagonal(row));
    each_other(row, f);
  }
  template <class F>  // f(column, block) for all but the diagonal
  void each_other(int row, const F& f) const {
    for (const BlockRows* part : {&lower_, &upper_}) {
      const BlockRows::Row blocks = (*part)[row];
      for (int k = 0; k < blocks.count; ++k) f(blocks.column[k], blocks[k]);
    }
  }

  // One sweep down and one up, from x = 0 (whatever x holds) or from x. Where asked they give r - A x or A x
  // of the new x. `change` is scratch. No two of the vectors may be the same.
  void sweep_from_zero(const VecX& r, VecX& x, VecX& change, VecX& residual) const;
  void sweep(const VecX& r, VecX& x, VecX& change) const;
  void sweep(const VecX& r, VecX& x, VecX& change, VecX& Ax) const;

 private:
  template <class F>  // f(chunk, begin, end), for every odd or every even chunk
  void for_chunks_of(bool odd, const F& f) const;
  // `change` becomes x_new - y. Calls f(row, L change of this row), unless f is null.
  template <bool from_zero, class F>
  void down_and_up(const VecX& r, VecX& x, VecX& change, const F& f) const;
  Four solve_diagonal(int row, const Four& right) const;

  int rows_ = 0;
  BlockRows lower_, upper_;                 // in chunks that are those of the sweeps
  std::vector<double> diagonal_, inverse_;  // D and D^-1: 9 a row, and 1 more
};

template <class Rows>
void Smoother::build(const Rows& A) {
  rows_ = A.rows();
  const int chunk_rows = std::max(A.bandwidth(), 256);
  lower_.resize(rows_, chunk_rows);
  upper_.resize(rows_, chunk_rows);
  diagonal_.resize(9 * static_cast<std::size_t>(rows_) + 1);
  inverse_.resize(diagonal_.size());
  parallel_for(lower_.chunk_count(), rows_ < serial_below(Work::heavy), [&](int chunk) {
    const bool odd = chunk % 2 == 1;
    const int first = chunk * lower_.chunk_rows(), last = std::min(rows_, first + lower_.chunk_rows());
    BlockRows::Chunk &lower = lower_.open(first, 8), &upper = upper_.open(first, 8);
    for (int r = first; r < last; ++r) {
      WideBlock own, lost;
      A.each(r, [&](int c, const auto* block, bool turned) {
        if (c == r) return own.add(block);
        const FloatBlock kept(block);
        const bool before = first <= c && c < last ? c < r : odd;
        // A slack spring is zero, but nothing foretells which ones are: so there is no branch on that.
        float* to = (before ? lower : upper).add_if(!kept.is_zero(), c);
        (turned ? kept.transpose() : kept).store(to);
        lost.add_lost(block, kept);
      });
      Mat3 exact, less;
      own.store(exact.data());
      lost.store(less.data());
      Mat3 D = exact + 0.5 * (less + less.transpose());
      if (!positive_definite(D)) D = exact;
      Eigen::Map<Mat3>(diagonal_.data() + 9 * static_cast<std::ptrdiff_t>(r)) = D;
      Eigen::Map<Mat3>(inverse_.data() + 9 * static_cast<std::ptrdiff_t>(r)) = D.inverse();
      lower.end_row();
      upper.end_row();
    }
  });
}

}  // namespace drape::internal
