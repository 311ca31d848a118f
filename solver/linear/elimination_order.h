// The order in which an incomplete factorisation eliminates the rows of a matrix, and which blocks it multiplies,
// listed once for a pattern.
//   Rows are cut into at most eight chunks, at least as long as the bandwidth, and those of the even chunks come
//   before those of the odd ones. Two chunks of one kind have no coupling, so they are eliminated at the same time.
//   (Every cut costs iterations: a hung sheet of 10 k vertices took 120 with one chunk, 125 with 8, 153 with 40.)
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mesh/base/parallel.h"
#include "solver/linear/mirror.h"
#include "solver/matrix/block_pattern.h"

namespace drape::internal {

// The upper triangle of the matrix in the order of elimination.
class EliminationOrder {
 public:
  struct Block {
    int column;   // in the order of elimination
    int slot;     // of the matrix
    bool turned;  // the matrix stores the transpose of this block
  };
  // The places of the blocks L_ji and A_ik, whose product is subtracted from A_jk.
  struct Update {
    int factor, from;
  };

  explicit EliminationOrder(const BlockPattern& A);

  int rows() const { return static_cast<int>(row_.size()); }
  int row(int i) const { return row_[i]; }  // of the matrix
  const std::vector<Block>& blocks() const { return block_; }
  // The blocks of row i are those from start(i), its diagonal, to start(i + 1).
  int start(int i) const { return start_[i]; }
  const Mirror& below() const { return below_; }      // the blocks of each column above its diagonal
  std::span<const Update> updates(int place) const {  // of the block A_jk that stands there, i ascending
    return {update_.data() + update_start_[place], update_.data() + update_start_[place + 1]};
  }
  // Calls f(begin, end) for every even chunk of rows, then for every odd one; backwards the other way round.
  template <class F>
  void for_chunks(bool backwards, const F& f) const {
    for (const int parity : {backwards ? 1 : 0, backwards ? 0 : 1}) {
      const int first = parity == 0 ? 0 : even_rows_, last = parity == 0 ? even_rows_ : rows();
      parallel_for((last - first + chunk_rows_ - 1) / chunk_rows_, rows() < serial_below,
                   [&](int k) { f(first + k * chunk_rows_, std::min(last, first + (k + 1) * chunk_rows_)); });
    }
  }

 private:
  void list_updates();

  int chunk_rows_, even_rows_ = 0;
  std::vector<int> row_, start_{0};
  std::vector<Block> block_;
  Mirror below_;
  std::vector<int> update_start_{0};
  std::vector<Update> update_;
};

}  // namespace drape::internal
