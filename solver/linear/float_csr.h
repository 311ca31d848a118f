// A matrix of 3x3 blocks in float, to be multiplied with row by row inside a preconditioner.
#pragma once

#include <vector>

#include "solver/linear/block_csr.h"

namespace drape {

using VecXf = Eigen::VectorXf;
typedef float FourFloats __attribute__((vector_size(16), aligned(4)));

class FloatCsr {
 public:
  FloatCsr() = default;
  // Row new_row of this is row old_row(new_row) of A, with the columns renamed; keep(new_row, new_column)
  // says which blocks.
  template <class OldRow, class NewColumn, class Keep>
  FloatCsr(const BlockCsr& A, const OldRow& old_row, const NewColumn& new_column, const Keep& keep) {
    start_.reserve(A.start.size());
    column_.reserve(A.column.size());
    value_.reserve(9 * A.column.size() + 1);
    for (int r = 0; r < A.rows(); ++r) {
      const int old = old_row(r);
      for (int k = A.begin(old); k < A.end(old); ++k) {
        const int c = new_column(A.at(k));
        if (!keep(r, c)) continue;
        column_.push_back(c);
        for (int e = 0; e < 9; ++e) value_.push_back(static_cast<float>(A[k].data()[e]));
      }
      start_.push_back(static_cast<int>(column_.size()));
    }
    value_.push_back(0);  // so that the last column can be read four wide
  }

  int rows() const { return static_cast<int>(start_.size()) - 1; }

  // (this x) of a row: three of the four lanes count.
  FourFloats times(int row, const float* x) const {
    FourFloats sum = {0, 0, 0, 0}, sum1 = sum, sum2 = sum;
    const int begin = start_[static_cast<std::size_t>(row)], end = start_[static_cast<std::size_t>(row) + 1];
    const float* a = value_.data() + 9 * static_cast<std::ptrdiff_t>(begin);
    for (int k = begin; k < end; ++k, a += 9) {
      const float* xj = x + 3 * static_cast<std::ptrdiff_t>(column_[static_cast<std::size_t>(k)]);
      sum += load(a) * xj[0];
      sum1 += load(a + 3) * xj[1];
      sum2 += load(a + 6) * xj[2];
    }
    return sum + sum1 + sum2;
  }

 private:
  static FourFloats load(const float* p) { return *reinterpret_cast<const FourFloats*>(p); }

  std::vector<int> start_{0}, column_;
  std::vector<float> value_;
};

}  // namespace drape
