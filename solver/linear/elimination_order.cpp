#include "solver/linear/elimination_order.h"

#include <utility>

#include "solver/linear/projected_block.h"

namespace drape::internal {

void EliminationOrder::build(const BlockMatrix& A) {
  order_rows(A);
  list_blocks(A);
  list_updates();
}

void EliminationOrder::order_rows(const BlockMatrix& A) {
  const int chunk_rows = std::max(A.pattern().chunk_rows(), (A.rows() + most_chunks - 1) / most_chunks);
  const int chunks = (A.rows() + chunk_rows - 1) / chunk_rows;
  // Bit k of coupled[l], k <= l, says whether a block couples the chunks k and l.
  std::array<unsigned, most_chunks> coupled = {};
  for (int r = 0; r < A.rows(); ++r)
    A.each(r, [&](int c, int) { coupled[c / chunk_rows] |= 1u << (r / chunk_rows); });
  std::array<int, most_chunks> colour_of = {};
  colours_ = 0;
  for (int l = 0; l < chunks; ++l) {
    unsigned taken = 0;
    for (int k = 0; k < l; ++k)
      if ((coupled[l] >> k & 1u) != 0) taken |= 1u << colour_of[k];
    while ((taken >> colour_of[l] & 1u) != 0) ++colour_of[l];
    colours_ = std::max(colours_, colour_of[l] + 1);
  }
  row_.clear();
  place_.resize(static_cast<std::size_t>(A.rows()));
  int ordered = 0;
  for (int colour = 0; colour < colours_; ++colour) {
    colour_start_[colour] = ordered;
    for (int k = 0; k < chunks; ++k) {
      if (colour_of[k] != colour) continue;
      chunk_start_[ordered++] = rows();
      for (int r = k * chunk_rows; r < std::min(A.rows(), (k + 1) * chunk_rows); ++r) {
        place_[r] = rows();
        row_.push_back(r);
      }
    }
  }
  colour_start_[colours_] = ordered;
  chunk_start_[ordered] = rows();
}

void EliminationOrder::list_blocks(const BlockMatrix& A) {
  find_below_diagonal(A, left_);
  block_.clear();
  block_.reserve(static_cast<std::size_t>(A.pattern().blocks() + A.overlay().blocks()));
  start_.assign(1, 0);
  for (int i = 0; i < rows(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(block_.size());
    const auto add = [&](int column, int slot, bool turned) {
      if (place_[column] >= i) block_.push_back({place_[column], slot, turned});
    };
    left_.in_column(row_[i], [&](int r, int slot) { add(r, slot, true); });
    A.each(row_[i], [&](int c, int slot) { add(c, slot, false); });
    std::sort(block_.begin() + first, block_.end(),
              [](const Block& a, const Block& b) { return a.column < b.column; });
    start_.push_back(static_cast<int>(block_.size()));
  }
  below_.build(rows(), rows(), [&](int i, const auto& f) {
    for (int k = start(i) + 1; k < start(i + 1); ++k) f(block_[k].column, k);
  });
  far_.build(A.overlay().empty() ? 0 : rows(), rows(), [&](int i, const auto& f) {
    for (int k = start(i) + 1; k < start(i + 1); ++k) {
      if (block_[k].slot < A.pattern().blocks()) continue;
      f(i, k);
      f(block_[k].column, k);
    }
  });
}

void EliminationOrder::list_updates() {
  update_start_.resize(block_.size());
  update_count_.resize(block_.size());
  update_.resize(static_cast<std::size_t>(heavy_chunk_count(rows())));
  drape::for_chunks<Work::heavy>(rows(), [&](int begin, int end) {
    thread_local std::vector<int> factor_of;  // row i -> place of A_ij, for one j; else -1
    if (factor_of.size() < row_.size()) factor_of.assign(row_.size(), -1);
    std::vector<Update> list = std::move(update_[begin / heavy_chunk_size(rows())]);
    list.clear();
    for (int j = begin; j < end; ++j) {
      below_.in_column(j, [&](int i, int place) { factor_of[i] = place; });
      for (int to = start(j); to < start(j + 1); ++to) {
        update_start_[to] = static_cast<int>(list.size());
        below_.in_column(block_[to].column, [&](int i, int from) {
          if (i < j && factor_of[i] >= 0) list.push_back({factor_of[i], from});
        });
        update_count_[to] = static_cast<int>(list.size()) - update_start_[to];
      }
      below_.in_column(j, [&](int i, int) { factor_of[i] = -1; });
    }
    update_[begin / heavy_chunk_size(rows())] = std::move(list);
  });
}

}  // namespace drape::internal
