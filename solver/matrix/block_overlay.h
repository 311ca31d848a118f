// The blocks that come and go, beside a pattern that does not change: one for every two rows that touch in
// this step and are not neighbours in the pattern.
//   A block (i, j), i < j, is stored once and also stands for its transpose (j, i), as in the pattern. Both
//   are listed, row by row with ascending columns, so that a product gathers each row by itself: the sums
//   have one order, whatever the number of threads and however far apart i and j are.
// The diagonal blocks are always those of the pattern. A preconditioner that is made from the pattern alone
// therefore has the diagonal parts of the overlay, and stays positive definite without the rest.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/matrix/block_pattern.h"

namespace drape {

class BlockOverlay {
 public:
  struct Entry {
    int column;
    int slot;         // of the block (min, max) in the matrix, after the slots of the pattern
    bool transposed;  // the row is the larger of the two indices
  };

  // Takes the blocks that these pairs of particles need and the pattern lacks; pairs may come in any order
  // and repeat. True when the blocks have changed, which gives the overlay a new serial. Memory is kept for
  // the next call. `pairs` is scratch: it ends as the pairs of rows.
  bool assign(const BlockPattern& pattern, std::vector<ParticlePair>& pairs);
  void clear();

  bool empty() const { return pairs_.empty(); }
  int blocks() const { return static_cast<int>(pairs_.size()); }
  std::uint64_t serial() const { return serial_; }  // differs between any two patterns and overlays
  int slot(int row, int column) const;              // row < column; -1: there is no such block

  // The rows that have blocks, ascending, and their entries with columns ascending.
  int row_count() const { return static_cast<int>(rows_.size()); }
  int row(int k) const { return rows_[k]; }
  int row_begin(int k) const { return start_[k]; }  // in entries()
  const std::vector<Entry>& entries() const { return entries_; }
  template <class F>  // f(entry)
  void in_row(int k, const F& f) const {
    for (int e = start_[k]; e < start_[k + 1]; ++e) f(entries_[e]);
  }
  // Calls f(entry) for the entries right of the diagonal in any row of the matrix.
  template <class F>
  void right_of_diagonal(int row, const F& f) const {
    if (empty()) return;
    if (const int k = place_[row]; k >= 0)
      in_row(k, [&](const Entry& e) {
        if (!e.transposed) f(e);
      });
  }

 private:
  void sort(std::vector<ParticlePair>& pairs, int rows);
  void list_rows(int rows);

  int first_slot_ = 0;
  std::uint64_t serial_ = 0;
  std::vector<ParticlePair> pairs_;  // rows i < j, ascending
  std::vector<int> rows_, start_;
  std::vector<Entry> entries_;
  std::vector<int> place_;  // row of the matrix -> k; -1: it has no blocks here
  // Scratch: pairs by their first rows, and where those of each row begin.
  std::vector<ParticlePair> by_row_;
  std::vector<int> row_begin_;
};

// A pattern and the overlay beside it: they say where every block stands.
struct BlockLayout {
  BlockLayout(const BlockPattern& pattern, const BlockOverlay& beside) : base(pattern), overlay(beside) {}
  BlockLayout(const BlockPattern& pattern) : BlockLayout(pattern, no_overlay()) {}

  const BlockPattern& base;
  const BlockOverlay& overlay;

  // row <= column; throws std::logic_error when there is no such block
  int slot(int row, int column) const {
    if (!overlay.empty())
      if (const int found = overlay.slot(row, column); found >= 0) return found;
    return base.slot(row, column);
  }

 private:
  static const BlockOverlay& no_overlay();
};

}  // namespace drape
