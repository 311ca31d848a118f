// The global sparse symmetric matrix in 3x3 blocks: a base whose pattern does not change
// (solver/matrix/block_pattern.h), an overlay of blocks that come and go (solver/matrix/block_overlay.h), and
// values that are refilled in every step. A block is stored column by column in 9 doubles.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "solver/matrix/block_overlay.h"
#include "solver/matrix/block_pattern.h"

namespace drape {

// A block that is added to the diagonal block of a row.
struct DiagonalBlock {
  int row;
  Mat3 block;
};

class BlockMatrix {
 public:
  // The overlay may change its blocks; the matrix follows at the next set_to_mass(). Null: there is no
  // overlay.
  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern,
                       std::shared_ptr<const BlockOverlay> overlay = nullptr);

  const BlockPattern& pattern() const { return *pattern_; }
  const BlockOverlay& overlay() const { return *overlay_; }
  int rows() const { return pattern_->rows(); }
  // The serial of base and overlay together: a solver that analyses the whole matrix has to compare this one.
  std::uint64_t serial() const { return overlay_->empty() ? pattern_->serial() : overlay_->serial(); }

  double* block(int slot) { return values_.data() + 9 * static_cast<std::size_t>(slot); }
  const double* block(int slot) const { return values_.data() + 9 * static_cast<std::size_t>(slot); }
  Eigen::Map<Mat3> at(int slot) { return Eigen::Map<Mat3>(block(slot)); }
  Eigen::Map<const Mat3> at(int slot) const { return Eigen::Map<const Mat3>(block(slot)); }

  // Calls f(column, slot) for the blocks of a row from the diagonal on, columns ascending, those of the
  // overlay among them.
  template <class F>
  void each(int row, const F& f) const;

  // Sets all to zero but the diagonal blocks, which become the mass of the row's particle times the identity.
  void set_to_mass(const std::vector<double>& mass);
  // Keeps the base as it is now, before anything is in the overlay or added to the diagonal; and takes it
  // back as it was kept, with an empty overlay, in place of a set_to_mass() and of what was assembled since.
  void keep();
  void take_kept();
  // Sets what is added to the assembled diagonal, in place of the additions of the last call: a contact that
  // rubs in another way needs no new assembly. A row may occur once at most.
  void set_diagonal_additions(std::span<const DiagonalBlock> additions);

  // Differs between any two calls of set_to_mass() and take_kept() in a process. What was assembled after the
  // same call differs by the additions to the diagonal alone.
  std::uint64_t fill() const { return fill_; }

  // To be called when all has been assembled, and again after anything is added to the overlay: products
  // leave out the blocks of the overlay that are zero, which half of them are, because what is near enough to
  // meet mostly does not push.
  void leave_out_zeros();

  void multiply(const VecX& x, VecX& y) const;     // y = A x, in row order
  void add_overlay(const VecX& x, VecX& y) const;  // y += what the overlay's blocks give of A x

 private:
  void clear_overlay();
  void multiply_base(const VecX& x, VecX& y) const;

  std::shared_ptr<const BlockPattern> pattern_;
  std::shared_ptr<const BlockOverlay> overlay_;
  std::uint64_t fill_ = 0;
  std::vector<double> values_;  // 9 a block, and 3 more, so that the last column can be read four wide
  std::vector<double> kept_;    // the base
  // Where the entries of each row of the overlay end that are not left out; they stand in `acting_` where the
  // row begins in the overlay.
  std::vector<BlockOverlay::Entry> acting_;
  std::vector<int> acting_end_;
  std::uint64_t acting_serial_ = 0;  // of the overlay that these are of
  // The slots of the diagonal blocks that have additions, and these blocks without them.
  std::vector<std::pair<int, Mat3>> assembled_;
};

template <class F>
void BlockMatrix::each(int row, const F& f) const {
  int s = pattern_->diagonal(row);
  const int end = pattern_->row_start()[row + 1];
  const auto column = [&] { return pattern_->column()[s]; };
  overlay_->right_of_diagonal(row, [&](const BlockOverlay::Entry& e) {
    for (; s < end && column() < e.column; ++s) f(column(), s);
    f(e.column, e.slot);
  });
  for (; s < end; ++s) f(column(), s);
}

}  // namespace drape
