// Loops over fixed chunks. The chunks depend on the size and the kind of the work only, never on the number
// of threads, and every sum is taken chunk by chunk in order. So 1, 2 or 7 threads give the same bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "mesh/base/threads.h"

namespace drape {

// What a loop does for each item. Light: it reads and writes a few numbers of a vector. Heavy: it goes
// through a row of a matrix, or works out a force or a contact.
enum class Work { light, heavy };

// For fewer items a second thread costs more than it brings.
constexpr int serial_below(Work work) { return work == Work::light ? 2000 : 600; }

// Calls f(k) for k = 0 .. count-1, in any order. f(k) must not write what another call f(l) touches.
template <class F>
void parallel_for(int count, bool serial, const F& f) {
  if (serial || count < 2 || threads() == 1) {
    for (int k = 0; k < count; ++k) f(k);
    return;
  }
  run_in_parallel(
      count, [](const void* context, int k) { (*static_cast<const F*>(context))(k); }, &f);
}

// Calls f(k) for k = 0 .. count-1: first for the even k in any order, then for the odd ones. So f(k) may
// write what belongs to k and to k + 1, and sums are taken in the same order on any number of threads.
template <class F>
void even_then_odd(int count, bool serial, const F& f) {
  for (int parity = 0; parity < 2; ++parity)
    parallel_for((count + 1 - parity) / 2, serial, [&](int k) { f(2 * k + parity); });
}

inline constexpr int chunk_size = 512;
inline int chunk_count(int n) { return (n + chunk_size - 1) / chunk_size; }

// Chunks of heavy work on few items are small, so that two threads share them evenly. All sums have chunks of
// one size.
constexpr int heavy_chunk_size(int n) { return n < 8192 ? 128 : chunk_size; }
inline int heavy_chunk_count(int n) { return (n + heavy_chunk_size(n) - 1) / heavy_chunk_size(n); }

// Calls f(begin, end) for consecutive chunks of [0, n).
template <Work work = Work::light, class F>
void for_chunks(int n, const F& f) {
  const int size = work == Work::light ? chunk_size : heavy_chunk_size(n);
  parallel_for((n + size - 1) / size, n < serial_below(work),
               [&](int k) { f(k * size, std::min(n, (k + 1) * size)); });
}

// The sum of f(begin, end) over the chunks of [0, n). f returns one number or any type that has +=. Groups of
// up to `max_partials` chunks are computed in parallel and then added in order.
template <Work work = Work::light, class F>
auto sum_chunks(int n, const F& f) {
  using Sum = decltype(f(0, 0));
  constexpr int max_partials = 1024;
  std::array<Sum, max_partials> partial;
  Sum total{};
  const int chunks = chunk_count(n);
  for (int base = 0; base < chunks; base += max_partials) {
    const int here = std::min(max_partials, chunks - base);
    parallel_for(here, n < serial_below(work), [&](int k) {
      const int begin = (base + k) * chunk_size;
      partial[k] = f(begin, std::min(n, begin + chunk_size));
    });
    for (int k = 0; k < here; ++k) total += partial[k];
  }
  return total;
}

// The scalar product a . b of n numbers in a fixed order: eight running sums, which are then added in order.
// (Eigen's own reductions depend on where in memory a vector happens to begin.)
inline double dot_in_order(const double* a, const double* b, std::ptrdiff_t n) {
  std::array<double, 8> sum = {};
  std::ptrdiff_t i = 0;
  for (; i + 8 <= n; i += 8)
    for (std::ptrdiff_t k = 0; k < 8; ++k) sum[k] += a[i + k] * b[i + k];
  for (; i < n; ++i) sum[0] += a[i] * b[i];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

// The scalar product a . b of two vectors that have three numbers for each particle.
template <class Vector>
double dot(const Vector& a, const Vector& b) {
  return sum_chunks(static_cast<int>(a.size() / 3), [&](int begin, int end) {
    return dot_in_order(a.data() + 3 * static_cast<std::ptrdiff_t>(begin),
                        b.data() + 3 * static_cast<std::ptrdiff_t>(begin),
                        3 * static_cast<std::ptrdiff_t>(end - begin));
  });
}

}  // namespace drape
