#include "solver/linear/smoother.h"

#include <type_traits>

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

// Even chunks come first in the order. So L of an even chunk, and U of an odd one, stay within the chunk; U of an
// even chunk and L of an odd one reach into its neighbours, too. Hence an odd chunk can go up as soon as it went
// down, and an even one can multiply by L as soon as it went up.
template <bool from_zero, class F>
void Smoother::down_and_up(const VecX& r, VecX& x, VecX& change, const F& f) const {
  const auto down = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Four right = at(r, i) - of_lower(i, x);
      set(change, i, right);  // what the sweep up begins with
      set(x, i, solve_diagonal(i, from_zero ? right : right - times(upper_[i], x.data())));
    }
  };
  const auto up = [&](int begin, int end) {
    for (int i = end - 1; i >= begin; --i) {
      const Four solved = solve_diagonal(i, at(change, i) - times<true>(upper_[i], x.data()));
      set(change, i, solved - at(x, i));
      set(x, i, solved);
    }
  };
  const auto finish = [&](int begin, int end) {
    if constexpr (!std::is_null_pointer_v<F>)
      for (int i = begin; i < end; ++i) f(i);
  };
  for_rows_of(false, down);
  for_rows_of(true, [&](int begin, int end) {
    down(begin, end);
    up(begin, end);
  });
  for_rows_of(false, [&](int begin, int end) {
    up(begin, end);
    finish(begin, end);
  });
  if constexpr (!std::is_null_pointer_v<F>) for_rows_of(true, finish);
}

void Smoother::sweep_from_zero(const VecX& r, VecX& x, VecX& change, VecX& residual) const {
  down_and_up<true>(r, x, change, [&](int i) { set(residual, i, -of_lower(i, change)); });
}

void Smoother::sweep(const VecX& r, VecX& x, VecX& change) const {
  down_and_up<false>(r, x, change, nullptr);
}

void Smoother::sweep(const VecX& r, VecX& x, VecX& change, VecX& Ax) const {
  down_and_up<false>(r, x, change, [&](int i) { set(Ax, i, at(r, i) + of_lower(i, change)); });
}

}  // namespace drape::internal
