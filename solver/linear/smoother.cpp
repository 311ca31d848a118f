#include "solver/linear/smoother.h"

namespace drape::internal {

template <class F>
void Smoother::for_rows_of(bool odd, const F& f) const {
  const int chunks = (rows_ + chunk_rows_ - 1) / chunk_rows_;
  parallel_for((chunks + 1 - odd) / 2, rows_ < serial_below(Work::heavy), [&](int k) {
    const int begin = (2 * k + odd) * chunk_rows_;
    f(begin, std::min(rows_, begin + chunk_rows_));
  });
}

namespace {

Four at(const VecX& v, int row) {
  const Four value = {v[3 * row], v[3 * row + 1], v[3 * row + 2], 0};
  return value;
}

void set(VecX& v, int row, const Four& value) {
  for (int k = 0; k < 3; ++k) v[3 * static_cast<std::ptrdiff_t>(row) + k] = value[k];
}

}  // namespace

inline Four Smoother::solve_diagonal(int row, const Four& right) const {
  const double* d = inverse_.data() + 9 * static_cast<std::ptrdiff_t>(row);
  return load(d) * right[0] + load(d + 3) * right[1] + load(d + 6) * right[2];
}

inline Four Smoother::solved_upwards(int row, const VecX& r, const VecX& x) const {
  return solve_diagonal(row,
                        at(r, row) - times<true>(lower_[row], x.data()) - times<true>(upper_[row], x.data()));
}

void Smoother::down(const VecX& r, VecX& x, VecX& residual) const {
  for (const bool odd : {false, true})
    for_rows_of(odd, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) set(x, i, solve_diagonal(i, at(r, i) - times(lower_[i], x.data())));
    });
  for_chunks<Work::heavy>(rows_, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) set(residual, i, -times(upper_[i], x.data()));
  });
}

void Smoother::up(const VecX& r, VecX& x) const {
  for (const bool odd : {true, false})
    for_rows_of(odd, [&](int begin, int end) {
      for (int i = end - 1; i >= begin; --i) set(x, i, solved_upwards(i, r, x));
    });
}

void Smoother::up(const VecX& r, VecX& x, VecX& change, VecX& Ax) const {
  const auto sweep = [&](int begin, int end) {
    for (int i = end - 1; i >= begin; --i) {
      const Four solved = solved_upwards(i, r, x);
      set(change, i, solved - at(x, i));
      set(x, i, solved);
    }
  };
  const auto multiply = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) set(Ax, i, at(r, i) + times(lower_[i], change.data()));
  };
  for_rows_of(true, sweep);
  for_rows_of(false, [&](int begin, int end) {
    sweep(begin, end);
    multiply(begin, end);  // has no blocks in other chunks, and its own are at hand
  });
  for_rows_of(true, multiply);
}

}  // namespace drape::internal
