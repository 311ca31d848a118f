// The blocks of the projected matrix S A S + I - S, one by one, for preconditioners that copy them.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "constraints/filter.h"
#include "solver/linear/mirror.h"
#include "solver/matrix/block_matrix.h"

namespace drape::internal {

class ProjectedBlocks {
 public:
  // Writes into `entry_of_row`, which has to live as long as this. A caller that keeps the vector avoids an
  // allocation for the next system.
  ProjectedBlocks(const BlockMatrix& A, const Filter& filter, std::vector<int>& entry_of_row)
      : A_(A), filter_(filter), entry_(entry_of_row) {
    entry_.assign(static_cast<std::size_t>(A.rows()), -1);
    for (std::size_t e = 0; e < filter.entries().size(); ++e)
      entry_[filter.entries()[e].particle] = static_cast<int>(e);
  }

  bool free(int row) const { return entry_[row] < 0; }
  Mat3 S(int row) const { return free(row) ? Mat3(Mat3::Identity()) : entry(row).S; }
  // True when the particle of this row may not move at all.
  bool locked(int row) const { return !free(row) && entry(row).S.isZero(0); }

  // The block (row, column) that stands in the slot.
  Mat3 block(int slot, int row, int column) const {
    Mat3 b = A_.at(slot);
    if (free(row) && free(column)) return b;
    if (!free(row)) b = entry(row).S * b;
    if (!free(column)) b = b * entry(column).S;
    if (row == column) b += Mat3::Identity() - entry(row).S;
    return b;
  }

 private:
  const FilterEntry& entry(int row) const { return filter_.entries()[entry_[row]]; }

  const BlockMatrix& A_;
  const Filter& filter_;
  std::vector<int>& entry_;  // row -> entry of the filter, -1: free
};

// The blocks below the diagonal of the base, by rows: the place of an entry is the slot of its transpose.
inline Mirror below_diagonal(const BlockPattern& pattern) {
  Mirror below;
  below.build(pattern.rows(), pattern.rows(), [&](int r, const auto& f) {
    for (int s = pattern.diagonal(r) + 1; s < pattern.row_start()[r + 1]; ++s) f(pattern.column()[s], s);
  });
  return below;
}

// The same for the whole matrix, with the overlay; memory of `below` is used again.
inline void find_below_diagonal(const BlockMatrix& A, Mirror& below) {
  below.build(A.rows(), A.rows(), [&](int r, const auto& f) {
    A.each(r, [&](int c, int slot) {
      if (c != r) f(c, slot);
    });
  });
}

// The projected base of the matrix with both its halves, row by row, from which a preconditioner is made.
class ProjectedRows {
 public:
  ProjectedRows(const BlockMatrix& A, const ProjectedBlocks& projected, const Mirror& below)
      : A_(A), pattern_(A.pattern()), projected_(projected), below_(below) {}

  int rows() const { return pattern_.rows(); }
  int bandwidth() const { return pattern_.bandwidth(); }

  // Calls f(column, block, turned), columns ascending. Where `turned` the entry of the matrix is the
  // transpose of the block. One number behind the block can be read.
  template <class F>
  void each(int row, const F& f) const {
    double held[10];
    held[9] = 0;
    below_.in_column(row, [&](int c, int slot) { f(c, block(slot, c, row, held), true); });
    for (int s = pattern_.diagonal(row); s < pattern_.row_start()[row + 1]; ++s) {
      const int c = pattern_.column()[s];
      f(c, block(s, row, c, held), false);
    }
  }

 private:
  // That of the matrix itself, or a projected one in `held`.
  const double* block(int slot, int row, int column, double* held) const {
    if (projected_.free(row) && projected_.free(column)) return A_.block(slot);
    Eigen::Map<Mat3>{held} = projected_.block(slot, row, column);
    return held;
  }

  const BlockMatrix& A_;
  const BlockPattern& pattern_;
  const ProjectedBlocks& projected_;
  const Mirror& below_;
};

// Decides for a symmetric block by its leading minors.
inline bool positive_definite(const Mat3& b) {
  const double minor = b(0, 0) * b(1, 1) - b(0, 1) * b(1, 0);
  return b(0, 0) > 0 && minor > 0 && b.determinant() > 0;
}

}  // namespace drape::internal
