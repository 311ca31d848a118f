#include "solver/linear/elimination_order.h"

#include <cstdlib>
#include <numeric>
#include <utility>

#include "solver/linear/projected_block.h"

namespace drape::internal {

void EliminationOrder::build(const BlockMatrix& A) {
  find_below_diagonal(A, left_);
  place_.resize(static_cast<std::size_t>(A.rows()));
  sequence_.resize(place_.size());
  std::iota(sequence_.begin(), sequence_.end(), 0);
  cut(A.pattern().bandwidth());
  if (!colour_chunks(A)) {
    bring_near(A);
    colour_chunks(A);
  }
  order_rows();
  list_blocks(A);
  list_updates();
}

// Gives each chunk the first colour that no earlier one has to which a block couples it. Whether two colours
// are enough.
bool EliminationOrder::colour_chunks(const BlockMatrix& A) {
  std::vector<int>& chunk_of = place_;
  for (int k = 0; k < chunks_; ++k)
    for (int at = cut_[k]; at < cut_[k + 1]; ++at) chunk_of[sequence_[at]] = k;
  // Bit k of coupled[l], k <= l, says whether a block couples the chunks k and l.
  std::array<unsigned, most_chunks> coupled = {};
  for (int r = 0; r < A.rows(); ++r)
    A.each(r, [&](int c, int) {
      const auto [k, l] = std::minmax({chunk_of[r], chunk_of[c]});
      coupled[l] |= 1u << k;
    });
  colour_ = {};
  colours_ = 0;
  for (int l = 0; l < chunks_; ++l) {
    unsigned taken = 0;
    for (int k = 0; k < l; ++k)
      if ((coupled[l] >> k & 1u) != 0) taken |= 1u << colour_[k];
    while ((taken >> colour_[l] & 1u) != 0) ++colour_[l];
    colours_ = std::max(colours_, colour_[l] + 1);
  }
  return colours_ <= 2;
}

// A sequence in which also what blocks of the overlay couple stands near each other.
void EliminationOrder::bring_near(const BlockMatrix& A) {
  graph_.start.assign(1, 0);
  graph_.neighbour.clear();
  for (int r = 0; r < A.rows(); ++r) {
    left_.in_column(r, [&](int c, int) { graph_.neighbour.push_back(c); });
    A.each(r, [&](int c, int) {
      if (c != r) graph_.neighbour.push_back(c);
    });
    graph_.start.push_back(static_cast<int>(graph_.neighbour.size()));
  }
  locality_.find(graph_, sequence_);
  std::vector<int>& at = place_;
  for (int k = 0; k < A.rows(); ++k) at[sequence_[k]] = k;
  int bandwidth = 0;
  for (int r = 0; r < A.rows(); ++r)
    A.each(r, [&](int c, int) { bandwidth = std::max(bandwidth, std::abs(at[r] - at[c])); });
  cut(bandwidth);
  for (int k = 0; k < chunks_; ++k) std::sort(sequence_.begin() + cut_[k], sequence_.begin() + cut_[k + 1]);
}

void EliminationOrder::cut(int bandwidth) {
  const int count = static_cast<int>(sequence_.size());
  const int length =
      std::max({bandwidth, BlockPattern::shortest_chunk, (count + most_chunks - 1) / most_chunks});
  chunks_ = 0;
  for (int at = 0; at < count; at += length) cut_[chunks_++] = at;
  cut_[chunks_] = count;
}

void EliminationOrder::order_rows() {
  row_.clear();
  int ordered = 0;
  for (int colour = 0; colour < colours_; ++colour) {
    colour_start_[colour] = ordered;
    for (int k = 0; k < chunks_; ++k) {
      if (colour_[k] != colour) continue;
      chunk_start_[ordered++] = rows();
      for (int at = cut_[k]; at < cut_[k + 1]; ++at) {
        place_[sequence_[at]] = rows();
        row_.push_back(sequence_[at]);
      }
    }
  }
  colour_start_[colours_] = ordered;
  chunk_start_[ordered] = rows();
}

// Calls f(column, slot, turned) for each block of row i from its diagonal on.
template <class F>
void EliminationOrder::each_block(const BlockMatrix& A, int i, const F& f) const {
  const auto add = [&](int column, int slot, bool turned) {
    if (place_[column] >= i) f(place_[column], slot, turned);
  };
  left_.in_column(row_[i], [&](int r, int slot) { add(r, slot, true); });
  A.each(row_[i], [&](int c, int slot) { add(c, slot, false); });
}

void EliminationOrder::list_blocks(const BlockMatrix& A) {
  block_.resize(static_cast<std::size_t>(A.pattern().blocks() + A.overlay().blocks()));
  start_.assign(place_.size() + 1, 0);
  const auto each_row = [&](const auto& use) {
    drape::for_chunks<Work::heavy>(rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) use(i);
    });
  };
  each_row([&](int i) { each_block(A, i, [&](int, int, bool) { ++start_[i + 1]; }); });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  each_row([&](int i) {
    Block* const first = block_.data() + start(i);
    Block* last = first;
    each_block(A, i, [&](int column, int slot, bool turned) { *last++ = {column, slot, turned}; });
    std::sort(first, last, [](const Block& a, const Block& b) { return a.column < b.column; });
  });
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
