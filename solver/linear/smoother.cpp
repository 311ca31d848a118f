#include "solver/linear/smoother.h"

namespace drape::internal {

template <class F>
void Smoother::for_rows_of(bool odd, const F& f) const {
  const int chunks = (rows_ + chunk_rows_ - 1) / chunk_rows_;
  parallel_for((chunks + 1 - odd) / 2, rows_ < serial_below, [&](int k) {
    const int begin = (2 * k + odd) * chunk_rows_;
    f(begin, std::min(rows_, begin + chunk_rows_));
  });
}

inline void Smoother::solve_diagonal(int row, Four right, double* x) const {
  const double* d = inverse_.data() + 9 * static_cast<std::ptrdiff_t>(row);
  const Four solution = load(d) * right[0] + load(d + 3) * right[1] + load(d + 6) * right[2];
  for (int k = 0; k < 3; ++k) x[3 * static_cast<std::ptrdiff_t>(row) + k] = solution[k];
}

namespace {

Four at(const VecX& r, int row) {
  const Four value = {r[3 * row], r[3 * row + 1], r[3 * row + 2], 0};
  return value;
}

}  // namespace

void Smoother::down(const VecX& r, VecX& x, VecX& residual) const {
  for (const bool odd : {false, true})
    for_rows_of(odd, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) solve_diagonal(i, at(r, i) - times(lower_[i], x.data()), x.data());
    });
  for_chunks(rows_, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Four rest = -times(upper_[i], x.data());
      for (int k = 0; k < 3; ++k) residual[3 * i + k] = rest[k];
    }
  });
}

void Smoother::up(const VecX& r, VecX& x) const {
  for (const bool odd : {true, false})
    for_rows_of(odd, [&](int begin, int end) {
      for (int i = end - 1; i >= begin; --i)
        solve_diagonal(i, at(r, i) - times<true>(lower_[i], x.data()) - times<true>(upper_[i], x.data()),
                       x.data());
    });
}

}  // namespace drape::internal
