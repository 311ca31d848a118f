// Sparse matrices of 3x3 blocks that are built row by row, and the two operations that multigrid is made of:
//   multiply(A, B) = A B [Gustavson 1978],   transposed(A) = A^T.
// Internal to solver/linear. Blocks column by column; columns ascend within a row. Deterministic on any
// number of threads: rows are made in fixed chunks and put together in order.
#pragma once

#include <algorithm>
#include <vector>

#include "mesh/parallel.h"
#include "mesh/triangle_mesh.h"

namespace drape {

struct BlockCsr {
  int columns = 0;
  std::vector<int> start{0}, column;  // rows + 1; one a block
  std::vector<Mat3> block;

  int rows() const { return static_cast<int>(start.size()) - 1; }
  int begin(int row) const { return start[static_cast<std::size_t>(row)]; }
  int end(int row) const { return start[static_cast<std::size_t>(row) + 1]; }
  int at(int k) const { return column[static_cast<std::size_t>(k)]; }
  const Mat3& operator[](int k) const { return block[static_cast<std::size_t>(k)]; }
};

// make(row, part) appends the blocks of the row to part.column and part.block, for every row.
template <class Make>
BlockCsr build_rows(int rows, int columns, const Make& make) {
  const int chunks = chunk_count(rows);
  std::vector<BlockCsr> parts(static_cast<std::size_t>(chunks));
  parallel_for(chunks, rows < serial_below, [&](int k) {
    BlockCsr& part = parts[static_cast<std::size_t>(k)];
    part.columns = columns;
    for (int row = k * chunk_size; row < std::min(rows, (k + 1) * chunk_size); ++row) {
      make(row, part);
      part.start.push_back(static_cast<int>(part.column.size()));
    }
  });
  BlockCsr whole;
  whole.columns = columns;
  std::size_t blocks = 0;
  for (const BlockCsr& part : parts) blocks += part.column.size();
  whole.start.reserve(static_cast<std::size_t>(rows) + 1);
  whole.column.reserve(blocks);
  whole.block.reserve(blocks);
  for (BlockCsr& part : parts) {
    const int offset = static_cast<int>(whole.column.size());
    for (int r = 0; r < part.rows(); ++r) whole.start.push_back(offset + part.end(r));
    whole.column.insert(whole.column.end(), part.column.begin(), part.column.end());
    whole.block.insert(whole.block.end(), part.block.begin(), part.block.end());
    part = {};
  }
  return whole;
}

BlockCsr multiply(const BlockCsr& A, const BlockCsr& B);
BlockCsr transposed(const BlockCsr& A);

}  // namespace drape
