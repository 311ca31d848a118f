// The order in which an incomplete factorisation eliminates the rows of a matrix, and which blocks it
// multiplies, listed once for its blocks, those of the overlay among them.
//   Rows are cut into at most eight chunks, and these get two colours, so that no block couples two chunks
// of one colour: these are eliminated at the same time. Rows come in the order of their chunks' colours.
// Chunks of the rows as the matrix has them, at least as long as the bandwidth of the base, couple to the
// next one only, unless far parts of the cloth touch each other. Where these need a third colour, rows are
// put in an order in which what touches stands near, too [Cuthill & McKee 1969], and cut into chunks at
// least as long as its bandwidth. Within a chunk they come as in the matrix, layer by layer, which takes
// fewer iterations.
//   (Every cut costs iterations: a hung sheet of 10 k vertices took 120 with one chunk, 125 with 8, 153 with
// 40.)
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "mesh/base/parallel.h"
#include "solver/linear/mirror.h"
#include "solver/matrix/block_matrix.h"
#include "solver/matrix/locality_order.h"

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

  void build(const BlockMatrix& A);  // uses again the memory of the last one

  int rows() const { return static_cast<int>(row_.size()); }
  int row(int i) const { return row_[i]; }  // of the matrix
  const std::vector<Block>& blocks() const { return block_; }
  // The blocks of row i are those from start(i), its diagonal, to start(i + 1).
  int start(int i) const { return start_[i]; }
  const Mirror& below() const { return below_; }  // the blocks of each column above its diagonal
  const Mirror& far() const {
    return far_;
  }  // the blocks of the overlay, in row j and in column j of the triangle
  // The updates of the block A_jk of row j that stands at this place, i ascending.
  std::span<const Update> updates(int j, int place) const {
    return std::span(update_[j / heavy_chunk_size(rows())])
        .subspan(update_start_[place], update_count_[place]);
  }
  int colours() const { return colours_; }
  // Calls f(begin, end) for the chunks of rows of one colour, in any order.
  template <class F>
  void for_chunks_of(int colour, const F& f) const {
    const int first = colour_start_[colour];
    parallel_for(colour_start_[colour + 1] - first, rows() < serial_below(Work::heavy),
                 [&](int k) { f(chunk_start_[first + k], chunk_start_[first + k + 1]); });
  }
  // For every chunk, colour by colour; backwards the last colour comes first.
  template <class F>
  void for_chunks(bool backwards, const F& f) const {
    for (int c = 0; c < colours_; ++c) for_chunks_of(backwards ? colours_ - 1 - c : c, f);
  }

 private:
  static constexpr int most_chunks = 8;

  bool colour_chunks(const BlockMatrix& A);
  void bring_near(const BlockMatrix& A);
  void cut(int bandwidth);
  void order_rows();
  template <class F>
  void each_block(const BlockMatrix& A, int i, const F& f) const;
  void list_blocks(const BlockMatrix& A);
  void list_updates();

  Graph graph_;  // scratch: what base and overlay couple
  LocalityOrder locality_;
  std::vector<int> sequence_;  // the rows of the matrix, to be cut into chunks
  int chunks_ = 0;
  std::array<int, most_chunks + 1> cut_ = {};  // where in the sequence each begins
  std::array<int, most_chunks> colour_ = {};   // of each
  int colours_ = 0;
  // In the order of elimination: where the chunks begin, and which of them is the first of each colour.
  std::array<int, most_chunks + 1> chunk_start_ = {}, colour_start_ = {};
  std::vector<int> row_, start_, place_;  // place_: row of the matrix -> in the order of elimination
  std::vector<Block> block_;
  Mirror below_, far_, left_;  // left_: the blocks of the matrix below its diagonal
  // Each heavy chunk of rows has a list of its own. update_start_ and update_count_ say where in it those of
  // a place stand.
  std::vector<std::vector<Update>> update_;
  std::vector<int> update_start_, update_count_;
};

}  // namespace drape::internal
