#include "solver/linear/smoother.h"

#include <Eigen/LU>
#include <cstdlib>

namespace drape {

Smoother::Smoother(const BlockCsr& A) {
  const int n = A.rows();
  int bandwidth = 0;
  for (int r = 0; r < n; ++r)
    for (int k = A.begin(r); k < A.end(r); ++k) bandwidth = std::max(bandwidth, std::abs(A.at(k) - r));
  const int chunk_rows = std::max(bandwidth, 256);
  new_of_.resize(static_cast<std::size_t>(n));
  for (std::vector<int>* chunks : {&even_, &odd_}) {
    chunks->push_back(static_cast<int>(old_of_.size()));
    for (int begin = chunks == &even_ ? 0 : chunk_rows; begin < n; begin += 2 * chunk_rows) {
      for (int r = begin; r < std::min(n, begin + chunk_rows); ++r) {
        new_of_[static_cast<std::size_t>(r)] = static_cast<int>(old_of_.size());
        old_of_.push_back(r);
      }
      chunks->push_back(static_cast<int>(old_of_.size()));
    }
  }
  const auto old_row = [&](int r) { return old_of(r); };
  const auto new_column = [&](int c) { return new_of(c); };
  lower_ = FloatCsr(A, old_row, new_column, [](int r, int c) { return c < r; });
  upper_ = FloatCsr(A, old_row, new_column, [](int r, int c) { return c > r; });
  inverse_.assign(9 * static_cast<std::size_t>(n) + 1, 0);
  for (int r = 0; r < n; ++r)
    for (int k = A.begin(r); k < A.end(r); ++k)
      if (A.at(k) == r)
        Eigen::Map<Eigen::Matrix3f>(inverse_.data() + 9 * static_cast<std::ptrdiff_t>(new_of(r))) =
            A[k].inverse().cast<float>();
}

template <class F>
void Smoother::for_rows_of(bool odd, const F& f) const {
  const std::vector<int>& chunks = odd ? odd_ : even_;
  parallel_for(static_cast<int>(chunks.size()) - 1, rows() < serial_below, [&](int k) {
    f(chunks[static_cast<std::size_t>(k)], chunks[static_cast<std::size_t>(k) + 1]);
  });
}

inline void Smoother::solve_diagonal(int row, FourFloats right, float* x) const {
  const float* d = inverse_.data() + 9 * static_cast<std::ptrdiff_t>(row);
  const auto column = [&](int k) { return *reinterpret_cast<const FourFloats*>(d + 3 * k); };
  const FourFloats solution = column(0) * right[0] + column(1) * right[1] + column(2) * right[2];
  for (int k = 0; k < 3; ++k) x[3 * static_cast<std::ptrdiff_t>(row) + k] = solution[k];
}

namespace {

FourFloats at(const VecXf& r, int row) {
  const FourFloats value = {r[3 * row], r[3 * row + 1], r[3 * row + 2], 0};
  return value;
}

}  // namespace

void Smoother::down(const VecXf& r, VecXf& x, VecXf& residual) const {
  for (const bool odd : {false, true})
    for_rows_of(odd, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) solve_diagonal(i, at(r, i) - lower_.times(i, x.data()), x.data());
    });
  for_chunks(rows(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const FourFloats rest = -upper_.times(i, x.data());
      for (int k = 0; k < 3; ++k) residual[3 * i + k] = rest[k];
    }
  });
}

void Smoother::up(const VecXf& r, VecXf& x) const {
  for (const bool odd : {true, false})
    for_rows_of(odd, [&](int begin, int end) {
      for (int i = end - 1; i >= begin; --i)
        solve_diagonal(i, at(r, i) - lower_.times(i, x.data()) - upper_.times(i, x.data()), x.data());
    });
}

}  // namespace drape
