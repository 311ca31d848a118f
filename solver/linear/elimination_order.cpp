#include "solver/linear/elimination_order.h"

#include "solver/linear/projected_block.h"

namespace drape::internal {

EliminationOrder::EliminationOrder(const BlockPattern& A)
    : chunk_rows_(std::max(A.chunk_rows(), (A.rows() + 8 - 1) / 8)) {
  for (const int parity : {0, 1}) {
    for (int r = 0; r < A.rows(); ++r)
      if (r / chunk_rows_ % 2 == parity) row_.push_back(r);
    if (parity == 0) even_rows_ = rows();
  }
  std::vector<int> place(row_.size());
  for (int i = 0; i < rows(); ++i) place[row_[i]] = i;
  const Mirror left = below_diagonal(A);
  block_.reserve(static_cast<std::size_t>(A.blocks()));
  for (int i = 0; i < rows(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(block_.size());
    const auto add = [&](int column, int slot, bool turned) {
      if (place[column] >= i) block_.push_back({place[column], slot, turned});
    };
    left.in_column(row_[i], [&](int r, int slot) { add(r, slot, true); });
    for (int s = A.diagonal(row_[i]); s < A.row_start()[row_[i] + 1]; ++s) add(A.column()[s], s, false);
    std::sort(block_.begin() + first, block_.end(),
              [](const Block& a, const Block& b) { return a.column < b.column; });
    start_.push_back(static_cast<int>(block_.size()));
  }
  below_.build(rows(), rows(), [&](int i, const auto& f) {
    for (int k = start(i) + 1; k < start(i + 1); ++k) f(block_[k].column, k);
  });
  list_updates();
}

void EliminationOrder::list_updates() {
  std::vector<int> factor_of(row_.size(), -1);  // row i -> place of A_ij, for one j
  for (int j = 0; j < rows(); ++j) {
    below_.in_column(j, [&](int i, int place) { factor_of[i] = place; });
    for (int to = start(j); to < start(j + 1); ++to) {
      below_.in_column(block_[to].column, [&](int i, int from) {
        if (i < j && factor_of[i] >= 0) update_.push_back({factor_of[i], from});
      });
      update_start_.push_back(static_cast<int>(update_.size()));
    }
    below_.in_column(j, [&](int i, int) { factor_of[i] = -1; });
  }
}

}  // namespace drape::internal
