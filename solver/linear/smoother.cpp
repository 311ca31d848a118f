#include "solver/linear/smoother.h"

#include <type_traits>

namespace drape::internal {

template <class F>
void Smoother::for_chunks_of(bool odd, const F& f) const {
  parallel_for((lower_.chunk_count() + 1 - odd) / 2, rows_ < serial_below(Work::heavy), [&](int k) {
    const int chunk = 2 * k + odd, begin = chunk * lower_.chunk_rows();
    f(chunk, begin, std::min(rows_, begin + lower_.chunk_rows()));
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

// Even chunks come first in the order. So L of an even chunk, and U of an odd one, stay within the chunk; U
// of an even chunk and L of an odd one reach into its neighbours, too. Hence an odd chunk can go up as soon
// as it went down, and an even one can multiply by L as soon as it went up.
template <bool from_zero, class F>
void Smoother::down_and_up(const VecX& r, VecX& x, VecX& change, const F& f) const {
  const auto down = [&](int chunk, int begin, int end) {
    const BlockRows::Rows lower = lower_.in_chunk(chunk), upper = upper_.in_chunk(chunk);
    for (int i = begin; i < end; ++i) {
      Four right = at(r, i);
      const Four of_lower = times(lower[i - begin], x.data());
      set(change, i, right - of_lower);  // what the sweep up begins with
      if (!from_zero) right -= times(upper[i - begin], x.data());
      set(x, i, solve_diagonal(i, right - of_lower));  // what waits for the row before comes last
    }
  };
  const auto up = [&](int chunk, int begin, int end) {
    const BlockRows::Rows upper = upper_.in_chunk(chunk);
    for (int i = end - 1; i >= begin; --i) {
      const Four solved = solve_diagonal(i, at(change, i) - times<true>(upper[i - begin], x.data()));
      set(change, i, solved - at(x, i));
      set(x, i, solved);
    }
  };
  const auto finish = [&](int chunk, int begin, int end) {
    if constexpr (!std::is_null_pointer_v<F>) {
      const BlockRows::Rows lower = lower_.in_chunk(chunk);
      for (int i = begin; i < end; ++i) f(i, times(lower[i - begin], change.data()));
    }
  };
  for_chunks_of(false, down);
  for_chunks_of(true, [&](int chunk, int begin, int end) {
    down(chunk, begin, end);
    up(chunk, begin, end);
  });
  for_chunks_of(false, [&](int chunk, int begin, int end) {
    up(chunk, begin, end);
    finish(chunk, begin, end);
  });
  if constexpr (!std::is_null_pointer_v<F>) for_chunks_of(true, finish);
}

void Smoother::sweep_from_zero(const VecX& r, VecX& x, VecX& change, VecX& residual) const {
  down_and_up<true>(r, x, change, [&](int i, const Four& of_lower) { set(residual, i, -of_lower); });
}

void Smoother::sweep(const VecX& r, VecX& x, VecX& change) const {
  down_and_up<false>(r, x, change, nullptr);
}

void Smoother::sweep(const VecX& r, VecX& x, VecX& change, VecX& Ax) const {
  down_and_up<false>(r, x, change, [&](int i, const Four& of_lower) { set(Ax, i, at(r, i) + of_lower); });
}

}  // namespace drape::internal
