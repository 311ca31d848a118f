// Sparse matrices that a preconditioner makes and multiplies with row by row. An entry is a 3x3 block (column
// by column) or a single number; it is kept in float and calculated with in double. Rows stand together in
// fixed chunks. A chunk is made by one thread and stays where it was made: nothing is copied to put the
// matrix together, and the number of threads does not change it.
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "mesh/base/parallel.h"
#include "solver/matrix/four.h"

namespace drape::internal {

template <int width>
class SparseRows {
 public:
  class Chunk {
   public:
    // Adds an entry to the row that end_row() closes; the caller writes its numbers, and may write one more,
    // which means nothing.
    float* add(int column) { return add_if(true, column); }
    // The same, but the entry is forgotten again where it is not wanted. Nothing branches on that.
    float* add_if(bool wanted, int column) {
      if (count_ == column_.size()) expect(2 * count_ + 16);
      column_[count_] = column;
      float* value = value_.data() + width * count_;
      count_ += wanted;
      return value;
    }
    void end_row() { start_.push_back(static_cast<int>(count_)); }

   private:
    friend class SparseRows;
    void begin() {
      start_.assign(1, 0);
      count_ = 0;
    }
    void expect(std::size_t entries) {
      if (entries <= column_.size()) return;
      value_.resize(width * entries + 1);  // so that the last column can be read and written four wide
      column_.resize(entries);             // comes last, because its size says how many fit
    }

    std::size_t count_ = 0;  // entries; there is room for more
    std::vector<int> start_, column_;
    std::vector<float> value_;
  };
  struct Row {
    int count;
    const int* column;
    const float* value;
    const float* operator[](int k) const { return value + width * static_cast<std::ptrdiff_t>(k); }
  };
  // The rows of a chunk, counted from its first one.
  struct Rows {
    const int *start, *column;
    const float* value;
    Row operator[](int row) const {
      const int begin = start[row];
      return {start[row + 1] - begin, column + begin, value + width * static_cast<std::ptrdiff_t>(begin)};
    }
  };

  // Begins anew with this many rows, in chunks of at least so many. Each chunk is then opened and filled in
  // order. Chunks that are not needed keep their memory for a larger matrix.
  void resize(int rows, int chunk_rows = 1) {
    rows_ = rows;
    chunk_rows_ =
        static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(chunk_rows, heavy_chunk_size(rows)))));
    shift_ = std::countr_zero(static_cast<unsigned>(chunk_rows_));
    const auto needed = static_cast<std::size_t>(chunk_count());
    if (chunks_.size() < needed) chunks_.resize(needed);
  }
  int chunk_rows() const { return chunk_rows_; }
  int chunk_count() const { return (rows_ + chunk_rows_ - 1) / chunk_rows_; }
  Chunk& open(int first_row, int entries_a_row) {
    constexpr int more = 256;  // few rows may be longer than rows are on average
    Chunk& chunk = chunks_[first_row >> shift_];
    chunk.begin();
    chunk.expect(static_cast<std::size_t>(entries_a_row * chunk_rows_ + more));
    return chunk;
  }
  template <class Make>  // make(row, chunk) adds the entries of the row
  void build(int rows, int entries_a_row, const Make& make) {
    resize(rows);
    for_chunks<Work::heavy>(rows, [&](int begin, int end) {
      Chunk& chunk = open(begin, entries_a_row);
      for (int row = begin; row < end; ++row) {
        make(row, chunk);
        chunk.end_row();
      }
    });
  }

  int rows() const { return rows_; }
  Rows in_chunk(int k) const {
    const Chunk& chunk = chunks_[k];
    return {chunk.start_.data(), chunk.column_.data(), chunk.value_.data()};
  }
  Row operator[](int row) const { return in_chunk(row >> shift_)[row & (chunk_rows_ - 1)]; }

 private:
  int rows_ = 0, chunk_rows_ = chunk_size, shift_ = 9;  // a chunk has 2^shift rows
  std::vector<Chunk> chunks_;
};

using BlockRows = SparseRows<9>;

// A row of blocks times x; three of the four lanes count. Rows are taken upwards or downwards, and so are
// their blocks: where columns ascend, what the row before has just written comes last and does not hold up
// the rest of the sum. What comes `ahead` blocks later is fetched early, because the processor's own prefetch
// stops at every page.
template <bool upwards = false>
Four times(const BlockRows::Row& row, const double* x) {
  constexpr std::ptrdiff_t step = upwards ? -1 : 1, ahead = 64 * step;
  const int* column = row.column + (upwards ? row.count - 1 : 0);
  const float* a = row[upwards ? row.count - 1 : 0];
  __builtin_prefetch(column + ahead);
  Four sum = {0, 0, 0, 0}, sum1 = sum, sum2 = sum;
  for (int k = 0; k < row.count; ++k, column += step, a += 9 * step) {
    __builtin_prefetch(a + 9 * ahead);
    const double* xj = x + 3 * static_cast<std::ptrdiff_t>(*column);
    sum += load(a) * xj[0];
    sum1 += load(a + 3) * xj[1];
    sum2 += load(a + 6) * xj[2];
  }
  return sum + sum1 + sum2;
}

}  // namespace drape::internal
