#include "solver/matrix/block_overlay.h"

#include <algorithm>
#include <utility>

#include "mesh/base/parallel.h"

namespace drape {
namespace {

bool same(const ParticlePair& a, const ParticlePair& b) { return a.i == b.i && a.j == b.j; }

}  // namespace

bool BlockOverlay::assign(const BlockPattern& pattern, std::vector<ParticlePair>& pairs) {
  for_chunks<Work::heavy>(static_cast<int>(pairs.size()), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const auto [i, j] = std::minmax(pattern.row_of()[pairs[k].i], pattern.row_of()[pairs[k].j]);
      pairs[k] = i == j || pattern.has(i, j) ? ParticlePair{-1, -1} : ParticlePair{i, j};
    }
  });
  std::erase_if(pairs, [](const ParticlePair& p) { return p.i < 0; });
  sort(pairs, pattern.rows());
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  const bool stands = first_slot_ == pattern.blocks() &&
                      std::equal(pairs.begin(), pairs.end(), pairs_.begin(), pairs_.end(), same);
  if (stands) return false;
  first_slot_ = pattern.blocks();
  pairs_.assign(pairs.begin(), pairs.end());
  serial_ = next_pattern_serial();
  list_rows(pattern.rows());
  return true;
}

// Sorts pairs by their first rows, and those of equal first rows by the second.
void BlockOverlay::sort(std::vector<ParticlePair>& pairs, int rows) {
  row_begin_.assign(static_cast<std::size_t>(rows) + 2, 0);
  for (const ParticlePair& p : pairs) ++row_begin_[p.i + 2];
  for (int r = 2; r < rows + 2; ++r) row_begin_[r] += row_begin_[r - 1];
  by_row_.resize(pairs.size());
  for (const ParticlePair& p : pairs)
    by_row_[row_begin_[p.i + 1]++] = p;  // says where the row goes on, and in the end where it ends
  for_chunks<Work::heavy>(rows, [&](int begin, int end) {
    for (int r = begin; r < end; ++r)
      std::sort(by_row_.begin() + row_begin_[r], by_row_.begin() + row_begin_[r + 1],
                [](const ParticlePair& a, const ParticlePair& b) { return a.j < b.j; });
  });
  std::swap(pairs, by_row_);
}

void BlockOverlay::clear() {
  pairs_.clear();
  rows_.clear();
  start_.assign(1, 0);
  entries_.clear();
}

void BlockOverlay::list_rows(int rows) {
  place_.assign(static_cast<std::size_t>(rows), 0);  // at first counts the entries of each row
  for (const ParticlePair& p : pairs_) {
    ++place_[p.i];
    ++place_[p.j];
  }
  rows_.clear();
  start_.assign(1, 0);
  for (int r = 0; r < rows; ++r) {
    int& here = place_[r];
    if (here == 0) {
      here = -1;
      continue;
    }
    start_.push_back(start_.back() + here);
    here = static_cast<int>(rows_.size());
    rows_.push_back(r);
  }
  entries_.resize(2 * pairs_.size());
  // Each row is filled from its front: its start moves on meanwhile, and all starts are moved back at the
  // end. Pairs ascend, so that in every row the columns left of the diagonal come before those right of it,
  // and both ascend.
  const auto add = [&](int row, const Entry& entry) {
    const auto k = static_cast<std::size_t>(place_[row]);
    entries_[start_[k]++] = entry;
  };
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    add(pairs_[p].j, {pairs_[p].i, first_slot_ + static_cast<int>(p), true});
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    add(pairs_[p].i, {pairs_[p].j, first_slot_ + static_cast<int>(p), false});
  for (std::size_t k = start_.size() - 1; k > 0; --k) start_[k] = start_[k - 1];
  start_[0] = 0;
}

int BlockOverlay::slot(int row, int column) const {
  if (empty() || place_[row] < 0) return -1;
  const auto begin = entries_.begin() + start_[place_[row]], end = entries_.begin() + start_[place_[row] + 1];
  const auto at =
      std::lower_bound(begin, end, column, [](const Entry& e, int wanted) { return e.column < wanted; });
  return at != end && at->column == column && !at->transposed ? at->slot : -1;
}

const BlockOverlay& BlockLayout::no_overlay() {
  static const BlockOverlay none;
  return none;
}

}  // namespace drape
