#include "solver/linear/block_csr.h"

namespace drape {
namespace {

typedef double Four __attribute__((vector_size(32), aligned(8)));

// c += a b, blocks column by column: three of the four lanes count.
inline void add_product(const double* a, const double* b, Four* c) {
  const Four a0 = *reinterpret_cast<const Four*>(a), a1 = *reinterpret_cast<const Four*>(a + 3);
  const Four a2 = {a[6], a[7], a[8], 0};
  for (int k = 0; k < 3; ++k) c[k] += a0 * b[3 * k] + a1 * b[3 * k + 1] + a2 * b[3 * k + 2];
}

struct Wide {  // a block that is being summed up
  Four column[3] = {};
};

// One row of a product: which columns it has, and their blocks.
class RowSum {
 public:
  void prepare(int columns) {
    if (place_.size() != static_cast<std::size_t>(columns))
      place_.assign(static_cast<std::size_t>(columns), -1);
  }
  Four* at(int column) {
    int& place = place_[static_cast<std::size_t>(column)];
    if (place < 0) {
      place = static_cast<int>(column_.size());
      column_.push_back(column);
      if (sum_.size() < column_.size()) sum_.resize(2 * column_.size());
      sum_[static_cast<std::size_t>(place)] = {};
    }
    return sum_[static_cast<std::size_t>(place)].column;
  }
  void move_to(BlockCsr& part) {
    std::sort(column_.begin(), column_.end());
    for (int c : column_) {
      int& place = place_[static_cast<std::size_t>(c)];
      const Four* sum = sum_[static_cast<std::size_t>(place)].column;
      Mat3 block;
      for (int k = 0; k < 3; ++k)
        for (int r = 0; r < 3; ++r) block(r, k) = sum[k][r];
      part.column.push_back(c);
      part.block.push_back(block);
      place = -1;
    }
    column_.clear();
  }

 private:
  std::vector<int> place_, column_;
  std::vector<Wide> sum_;
};

}  // namespace

BlockCsr multiply(const BlockCsr& A, const BlockCsr& B) {
  std::vector<RowSum> sums(static_cast<std::size_t>(chunk_count(A.rows())));
  return build_rows(A.rows(), B.columns, [&](int row, BlockCsr& part) {
    RowSum& sum = sums[static_cast<std::size_t>(row / chunk_size)];
    sum.prepare(B.columns);
    for (int k = A.begin(row); k < A.end(row); ++k)
      for (int l = B.begin(A.at(k)); l < B.end(A.at(k)); ++l)
        add_product(A[k].data(), B[l].data(), sum.at(B.at(l)));
    sum.move_to(part);
    if (row + 1 == A.rows() || (row + 1) % chunk_size == 0) sum = {};
  });
}

BlockCsr transposed(const BlockCsr& A) {
  BlockCsr T;
  T.columns = A.rows();
  T.start.assign(static_cast<std::size_t>(A.columns) + 1, 0);
  for (int c : A.column) ++T.start[static_cast<std::size_t>(c) + 1];
  for (std::size_t c = 0; c < static_cast<std::size_t>(A.columns); ++c) T.start[c + 1] += T.start[c];
  T.column.resize(A.column.size());
  T.block.resize(A.block.size());
  std::vector<int> next(T.start.begin(), T.start.end() - 1);
  for (int r = 0; r < A.rows(); ++r)
    for (int k = A.begin(r); k < A.end(r); ++k) {
      const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(A.at(k))]++);
      T.column[place] = r;
      T.block[place] = A[k].transpose();
    }
  return T;
}

}  // namespace drape
