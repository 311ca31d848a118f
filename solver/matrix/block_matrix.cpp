#include "solver/matrix/block_matrix.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "mesh/base/parallel.h"
#include "solver/matrix/four.h"

namespace drape {
namespace {

// Neighbours of every particle: sorted, each once, without itself.
struct Graph {
  std::vector<int> start, neighbour;
  int degree(int i) const {
    return start[static_cast<std::size_t>(i) + 1] - start[static_cast<std::size_t>(i)];
  }
};

Graph make_graph(int particles, const std::vector<ParticlePair>& pairs) {
  Graph g;
  g.start.assign(static_cast<std::size_t>(particles) + 1, 0);
  for (const ParticlePair& p : pairs) {
    ++g.start[static_cast<std::size_t>(p.i) + 1];
    ++g.start[static_cast<std::size_t>(p.j) + 1];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(particles); ++i) g.start[i + 1] += g.start[i];
  g.neighbour.resize(2 * pairs.size());
  std::vector<int> next(g.start.begin(), g.start.end() - 1);
  for (const ParticlePair& p : pairs) {
    g.neighbour[static_cast<std::size_t>(next[static_cast<std::size_t>(p.i)]++)] = p.j;
    g.neighbour[static_cast<std::size_t>(next[static_cast<std::size_t>(p.j)]++)] = p.i;
  }
  int kept = 0;
  for (int i = 0; i < particles; ++i) {
    const auto first = g.neighbour.begin() + g.start[static_cast<std::size_t>(i)];
    const auto last = g.neighbour.begin() + g.start[static_cast<std::size_t>(i) + 1];
    std::sort(first, last);
    const int begin = kept;
    for (auto it = first; it != last; ++it)
      if (*it != i && (kept == begin || g.neighbour[static_cast<std::size_t>(kept - 1)] != *it))
        g.neighbour[static_cast<std::size_t>(kept++)] = *it;
    g.start[static_cast<std::size_t>(i)] = begin;
  }
  g.start.back() = kept;
  g.neighbour.resize(static_cast<std::size_t>(kept));
  return g;
}

// Breadth first from `root`; appends what it reaches to `order`, neighbours by rising degree, then number.
void breadth_first(const Graph& g, int root, std::vector<char>& seen, std::vector<int>& order) {
  std::size_t head = order.size();
  order.push_back(root);
  seen[static_cast<std::size_t>(root)] = 1;
  while (head < order.size()) {
    const int i = order[head++];
    const std::size_t first = order.size();
    for (int k = g.start[static_cast<std::size_t>(i)]; k < g.start[static_cast<std::size_t>(i) + 1]; ++k) {
      const int j = g.neighbour[static_cast<std::size_t>(k)];
      if (seen[static_cast<std::size_t>(j)]) continue;
      seen[static_cast<std::size_t>(j)] = 1;
      order.push_back(j);
    }
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(),
              [&](int a, int b) { return g.degree(a) != g.degree(b) ? g.degree(a) < g.degree(b) : a < b; });
  }
}

// Reverse Cuthill-McKee: each piece from an end of it (the last vertex of two searches).
std::vector<int> locality_order(const Graph& g) {
  const auto n = g.start.size() - 1;
  std::vector<int> order, trial;
  std::vector<char> seen(n, 0), scratch(n, 0);
  order.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (seen[i]) continue;
    int root = static_cast<int>(i);
    for (int round = 0; round < 2; ++round) {
      trial.clear();
      breadth_first(g, root, scratch, trial);
      for (int t : trial) scratch[static_cast<std::size_t>(t)] = 0;
      root = trial.back();
    }
    breadth_first(g, root, seen, order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

// y[0..2] += the sums of the lanes of p, q, r.
inline void add_sums(const Four& p, const Four& q, const Four& r, double* y) {
  typedef long long Lanes __attribute__((vector_size(32)));
  const Four pq = __builtin_shuffle(p, q, Lanes{0, 4, 2, 6}) + __builtin_shuffle(p, q, Lanes{1, 5, 3, 7});
  y[0] += pq[0] + pq[2];
  y[1] += pq[1] + pq[3];
  y[2] += (r[0] + r[1]) + r[2];
}

}  // namespace

BlockPattern::BlockPattern(int particles, std::vector<ParticlePair> pairs) {
  static std::atomic<std::uint64_t> count{0};
  serial_ = ++count;
  const Graph g = make_graph(particles, pairs);
  pairs = {};
  particle_of_ = locality_order(g);
  row_of_.resize(particle_of_.size());
  for (std::size_t r = 0; r < particle_of_.size(); ++r)
    row_of_[static_cast<std::size_t>(particle_of_[r])] = static_cast<int>(r);

  row_start_.assign(particle_of_.size() + 1, 0);
  column_.reserve(g.neighbour.size() / 2 + particle_of_.size());
  for (std::size_t r = 0; r < particle_of_.size(); ++r) {
    const auto i = static_cast<std::size_t>(particle_of_[r]);
    const auto first = static_cast<std::ptrdiff_t>(column_.size());
    const int row = static_cast<int>(r);
    column_.push_back(row);
    for (int k = g.start[i]; k < g.start[i + 1]; ++k)
      if (const int c = row_of_[static_cast<std::size_t>(g.neighbour[static_cast<std::size_t>(k)])]; c > row)
        column_.push_back(c);
    std::sort(column_.begin() + first, column_.end());
    row_start_[r + 1] = static_cast<int>(column_.size());
    bandwidth_ = std::max(bandwidth_, column_.back() - row);
  }
  chunk_rows_ = std::max(bandwidth_, 256);
}

int BlockPattern::slot(int row, int column) const {
  const auto first = column_.begin() + row_start_[static_cast<std::size_t>(row)];
  const auto last = column_.begin() + row_start_[static_cast<std::size_t>(row) + 1];
  const auto it = std::lower_bound(first, last, column);
  if (it == last || *it != column) throw std::logic_error("block pattern: no such block");
  return static_cast<int>(it - column_.begin());
}

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> pattern)
    : pattern_(std::move(pattern)), values_(9 * static_cast<std::size_t>(pattern_->blocks()) + 3, 0.0) {}

void BlockMatrix::set_to_mass(const std::vector<double>& mass) {
  const std::vector<int>& start = pattern_->row_start();
  for_chunks(rows(), [&](int begin, int end) {
    const auto first = 9 * static_cast<std::size_t>(start[static_cast<std::size_t>(begin)]);
    const auto last = 9 * static_cast<std::size_t>(start[static_cast<std::size_t>(end)]);
    std::memset(values_.data() + first, 0, (last - first) * sizeof(double));
    for (int r = begin; r < end; ++r)
      at(pattern_->diagonal(r)).diagonal().array() =
          mass[static_cast<std::size_t>(pattern_->particle_of()[static_cast<std::size_t>(r)])];
  });
}

// Row r of the upper triangle gives y_r += A_rj x_j and, as the block (j, r), y_j += A_rj^T x_r.
void BlockMatrix::multiply(const VecX& x, VecX& y) const {
  constexpr std::ptrdiff_t ahead = 9 * 128;  // doubles: the processor's own prefetch stops at every page
  const int* start = pattern_->row_start().data();
  const int* column = pattern_->column().data();
  const int chunk_rows = pattern_->chunk_rows(), chunks = pattern_->chunks();
  const auto first_row = [&](int chunk) { return std::min(chunk * chunk_rows, rows()); };
  even_then_odd(chunks, rows() < serial_below, [&](int chunk) {
    const int begin = first_row(chunk), end = first_row(chunk + 1);
    if (chunk % 2 == 0) y.segment(3 * begin, 3 * (first_row(chunk + 2) - begin)).setZero();
    const double* a = block(start[begin]);
    for (int r = begin; r < end; ++r) {
      const double* xr = x.data() + 3 * static_cast<std::ptrdiff_t>(r);
      const Four masked = {xr[0], xr[1], xr[2], 0};
      Four sum = load(a) * xr[0], sum1 = load(a + 3) * xr[1],
           sum2 = load(a + 6) * xr[2];  // lane 3 is never used
      a += 9;
      for (int s = start[r] + 1; s < start[r + 1]; ++s, a += 9) {
        __builtin_prefetch(a + ahead);
        __builtin_prefetch(a + ahead + 8);
        const auto j = 3 * static_cast<std::ptrdiff_t>(column[s]);
        const double* xj = x.data() + j;
        const Four c0 = load(a), c1 = load(a + 3), c2 = load(a + 6);
        sum += c0 * xj[0];
        sum1 += c1 * xj[1];
        sum2 += c2 * xj[2];
        add_sums(c0 * masked, c1 * masked, c2 * masked, y.data() + j);
      }
      sum += sum1 + sum2;
      double* out = y.data() + 3 * static_cast<std::ptrdiff_t>(r);
      out[0] += sum[0];
      out[1] += sum[1];
      out[2] += sum[2];
    }
  });
}

void to_rows(const BlockPattern& pattern, const VecX& by_particle, VecX& by_row) {
  for (int r = 0; r < pattern.rows(); ++r)
    by_row.segment<3>(3 * r) = by_particle.segment<3>(3 * pattern.particle_of()[static_cast<std::size_t>(r)]);
}

void to_particles(const BlockPattern& pattern, const VecX& by_row, VecX& by_particle) {
  for (int r = 0; r < pattern.rows(); ++r)
    by_particle.segment<3>(3 * pattern.particle_of()[static_cast<std::size_t>(r)]) = by_row.segment<3>(3 * r);
}

}  // namespace drape
