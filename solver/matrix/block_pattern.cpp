#include "solver/matrix/block_pattern.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <stdexcept>

#include "solver/matrix/locality_order.h"

namespace drape {
namespace {

internal::Graph make_graph(int particles, const std::vector<ParticlePair>& pairs) {
  internal::Graph g;
  g.start.assign(static_cast<std::size_t>(particles) + 1, 0);
  for (const ParticlePair& p : pairs) {
    ++g.start[p.i + 1];
    ++g.start[p.j + 1];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(particles); ++i) g.start[i + 1] += g.start[i];
  g.neighbour.resize(2 * pairs.size());
  std::vector<int> next(g.start.begin(), g.start.end() - 1);
  for (const ParticlePair& p : pairs) {
    g.neighbour[next[p.i]++] = p.j;
    g.neighbour[next[p.j]++] = p.i;
  }
  int kept = 0;
  for (int i = 0; i < particles; ++i) {
    const auto first = g.neighbour.begin() + g.start[i];
    const auto last = g.neighbour.begin() + g.start[i + 1];
    std::sort(first, last);
    const int begin = kept;
    for (auto it = first; it != last; ++it)
      if (*it != i && (kept == begin || g.neighbour[kept - 1] != *it)) g.neighbour[kept++] = *it;
    g.start[i] = begin;
  }
  g.start.back() = kept;
  g.neighbour.resize(static_cast<std::size_t>(kept));
  return g;
}

}  // namespace

BlockPattern::BlockPattern(int particles, std::vector<ParticlePair> pairs) {
  serial_ = next_pattern_serial();
  const internal::Graph g = make_graph(particles, pairs);
  pairs = {};
  internal::LocalityOrder().find(g, particle_of_);
  row_of_.resize(particle_of_.size());
  for (std::size_t r = 0; r < particle_of_.size(); ++r) row_of_[particle_of_[r]] = static_cast<int>(r);

  row_start_.assign(particle_of_.size() + 1, 0);
  column_.reserve(g.neighbour.size() / 2 + particle_of_.size());
  for (std::size_t r = 0; r < particle_of_.size(); ++r) {
    const auto i = static_cast<std::size_t>(particle_of_[r]);
    const auto first = static_cast<std::ptrdiff_t>(column_.size());
    const int row = static_cast<int>(r);
    column_.push_back(row);
    for (int k = g.start[i]; k < g.start[i + 1]; ++k)
      if (const int c = row_of_[g.neighbour[k]]; c > row) column_.push_back(c);
    std::sort(column_.begin() + first, column_.end());
    row_start_[r + 1] = static_cast<int>(column_.size());
    bandwidth_ = std::max(bandwidth_, column_.back() - row);
  }
  chunk_rows_ = std::max(bandwidth_, shortest_chunk);
}

int BlockPattern::find(int row, int column) const {
  const auto first = column_.begin() + row_start_[row];
  const auto last = column_.begin() + row_start_[row + 1];
  const auto it = std::lower_bound(first, last, column);
  return it == last || *it != column ? -1 : static_cast<int>(it - column_.begin());
}

bool BlockPattern::has(int row, int column) const { return find(row, column) >= 0; }

int BlockPattern::slot(int row, int column) const {
  const int found = find(row, column);
  if (found < 0) throw std::logic_error("block pattern: no such block");
  return found;
}

std::uint64_t next_pattern_serial() {
  static std::atomic<std::uint64_t> count{0};
  return ++count;
}

std::vector<int> connected_pieces(const BlockPattern& pattern) {
  std::vector<int> first(
      static_cast<std::size_t>(pattern.rows()));  // by row: one that it hangs together with
  std::iota(first.begin(), first.end(), 0);
  const auto least = [&](int row) {
    while (first[row] != row) row = first[row] = first[first[row]];
    return row;
  };
  for (int row = 0; row < pattern.rows(); ++row)
    for (int k = pattern.row_start()[row]; k < pattern.row_start()[row + 1]; ++k) {
      const int a = least(row), b = least(pattern.column()[k]);
      first[std::max(a, b)] = std::min(a, b);
    }
  std::vector<int> number(first.size(), -1), piece(first.size());  // number: of the piece, by its first row
  int pieces = 0;
  for (std::size_t particle = 0; particle < piece.size(); ++particle) {
    int& own = number[least(pattern.row_of()[particle])];
    if (own < 0) own = pieces++;
    piece[particle] = own;
  }
  return piece;
}

void to_rows(const BlockPattern& pattern, const VecX& by_particle, VecX& by_row) {
  for (int r = 0; r < pattern.rows(); ++r)
    by_row.segment<3>(3 * r) = by_particle.segment<3>(3 * pattern.particle_of()[r]);
}

void to_particles(const BlockPattern& pattern, const VecX& by_row, VecX& by_particle) {
  for (int r = 0; r < pattern.rows(); ++r)
    by_particle.segment<3>(3 * pattern.particle_of()[r]) = by_row.segment<3>(3 * r);
}

}  // namespace drape
