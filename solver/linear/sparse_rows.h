// Sparse matrices that a preconditioner makes and multiplies with row by row. An entry is a 3x3 block (column
// by column) or a single number; it is kept in float and calculated with in double. Rows stand together in
// fixed chunks. A chunk is made by one thread and stays where it was made: nothing is copied to put the
// matrix together, and the number of threads does not change it.
#pragma once

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
    // Adds an entry to the row that end_row() closes; the caller writes its numbers, and may write one more, which
    // means nothing.
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

  // Begins anew with this many rows. Each chunk of them is then opened and filled in order. Chunks that are not needed
  // keep their memory for a larger matrix.
  void resize(int rows) {
    rows_ = rows;
    chunk_rows_ = heavy_chunk_size(rows);
    shift_ = std::countr_zero(static_cast<unsigned>(chunk_rows_));
    const auto needed = static_cast<std::size_t>(heavy_chunk_count(rows));
    if (chunks_.size() < needed) chunks_.resize(needed);
  }
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
  Row operator[](int row) const {
    const Chunk& chunk = chunks_[row >> shift_];
    const int begin = chunk.start_[row & (chunk_rows_ - 1)];
    const int end = chunk.start_[static_cast<std::size_t>(row & (chunk_rows_ - 1)) + 1];
    return {end - begin, chunk.column_.data() + begin,
            chunk.value_.data() + width * static_cast<std::ptrdiff_t>(begin)};
  }

 private:
  int rows_ = 0, chunk_rows_ = chunk_size, shift_ = 9;  // a chunk has 2^shift rows
  std::vector<Chunk> chunks_;
};

using BlockRows = SparseRows<9>;

// A row of blocks times x; three of the four lanes count. Rows are taken upwards or downwards. What comes
// `ahead` blocks later is fetched early, because the processor's own prefetch stops at every page.
template <bool upwards = false>
Four times(const BlockRows::Row& row, const double* x) {
  constexpr std::ptrdiff_t ahead = (upwards ? -1 : 1) * 64;
  __builtin_prefetch(row.column + ahead);
  Four sum = {0, 0, 0, 0}, sum1 = sum, sum2 = sum;
  const float* a = row.value;
  for (int k = 0; k < row.count; ++k, a += 9) {
    __builtin_prefetch(a + 9 * ahead);
    const double* xj = x + 3 * static_cast<std::ptrdiff_t>(row.column[k]);
    sum += load(a) * xj[0];
    sum1 += load(a + 3) * xj[1];
    sum2 += load(a + 6) * xj[2];
  }
  return sum + sum1 + sum2;
}

}  // namespace drape::internal
