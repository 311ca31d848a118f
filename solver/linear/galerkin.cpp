#include "solver/linear/galerkin.h"

#include <algorithm>

#include "solver/linear/row_sum.h"

namespace drape::internal {

void transpose(const BlockRows& P, int columns, BlockRows& R) {
  Mirror by_column;
  by_column.build(P.rows(), columns, [&](int r, const auto& f) {
    for (int k = 0; k < P[r].count; ++k) f(P[r].column[k], k);
  });
  const int average = static_cast<int>(by_column.row.size()) / std::max(columns, 1) + 1;
  R.build(columns, average, [&](int row, BlockRows::Chunk& chunk) {
    by_column.in_column(row, [&](int r, int k) { FloatBlock(P[r][k]).transpose().store(chunk.add(r)); });
  });
}

const SymmetricRows& Galerkin::coarse(const Smoother& A, const BlockRows& P, const BlockRows& R) {
  const int columns = R.rows();
  product_.resize(A.rows());
  for_chunks<Work::heavy>(A.rows(), [&](int begin, int end) {
    RowSum sum(columns);
    BlockRows::Chunk& chunk = product_.open(begin, 8);
    for (int i = begin; i < end; ++i) {
      const BlockRows::Row own = P[i];  // A_c above its diagonal needs no columns before these
      const int least = own.count == 0 ? columns : *std::min_element(own.column, own.column + own.count);
      A.each(i, [&](int j, const auto* block) {
        const BlockRows::Row row = P[j];
        for (int k = 0; k < row.count; ++k)
          if (row.column[k] >= least) sum.at(row.column[k]).add_product(block, row[k]);
      });
      sum.take([&](int column, const WideBlock& block) { block.store(chunk.add(column)); });
      chunk.end_row();
    }
  });
  coarse_.upper_.resize(columns);
  for_chunks<Work::heavy>(columns, [&](int begin, int end) {
    RowSum sum(columns);
    BlockRows::Chunk& chunk = coarse_.upper_.open(begin, 8);
    for (int i = begin; i < end; ++i) {
      sum.at(i);  // puts the diagonal block first
      const BlockRows::Row row = R[i];
      for (int k = 0; k < row.count; ++k) {
        const BlockRows::Row product = product_[row.column[k]];
        for (int l = 0; l < product.count; ++l)
          if (product.column[l] >= i) sum.at(product.column[l]).add_product(row[k], product[l]);
      }
      sum.take([&](int column, const WideBlock& block) {
        float* to = chunk.add(column);
        block.store(to);
        if (column != i) return;
        to[3] = to[1], to[6] = to[2], to[7] = to[5];
        const float trace = to[0] + to[4] + to[8];
        for (int e = 0; e < 9; e += 4) to[e] += trace > 0 ? 2e-7f * trace : 1;
      });
      chunk.end_row();
    }
  });
  coarse_.bandwidth_ = 0;
  coarse_.below_.build(columns, columns, [&](int r, const auto& f) {
    const BlockRows::Row row = coarse_.upper_[r];
    for (int k = 1; k < row.count; ++k) {
      coarse_.bandwidth_ = std::max(coarse_.bandwidth_, row.column[k] - r);
      f(row.column[k], k);
    }
  });
  return coarse_;
}

}  // namespace drape::internal
