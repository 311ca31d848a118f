#include "constraints/rope_rest.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace drape::internal {
namespace {

double distance(const VecX& rest, int i, int j) {
  return (rest.segment<3>(3 * i) - rest.segment<3>(3 * j)).norm();
}

// The particles that each one is joined to by an edge.
std::vector<std::vector<int>> neighbours(const std::vector<SelfSegment>& segments,
                                         const std::vector<SelfFace>& faces, std::size_t particles) {
  std::vector<std::vector<int>> next(particles);
  const auto join = [&](int i, int j) {
    next[i].push_back(j);
    next[j].push_back(i);
  };
  for (const SelfSegment& segment : segments) join(segment.particles[0], segment.particles[1]);
  for (const SelfFace& face : faces)
    for (std::size_t k = 0; k < 3; ++k) join(face.particles[k], face.particles[(k + 1) % 3]);
  return next;
}

}  // namespace

void RopeRest::set(const std::vector<SelfSegment>& segments, const std::vector<SelfFace>& faces,
                   const VecX& rest, int particles) {
  chain_.clear();
  if (segments.empty()) return;
  const auto n = static_cast<std::size_t>(particles);
  chain_.assign(n, -1);
  along_.assign(n, 0);
  of_rope_.assign(n, 0);
  is_joint_.assign(n, 0);
  int chain = -1;
  double along = 0, thickest = 0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const auto [i, j] = segments[k].particles;
    const bool goes_on =
        k > 0 && segments[k - 1].sheet == segments[k].sheet && segments[k - 1].particles[1] == i;
    if (!goes_on) {
      ++chain;
      along = 0;
    }
    const double end = along + distance(rest, i, j);
    for (const auto& [particle, place] : {std::pair(i, along), std::pair(j, end)}) {
      if (chain_[particle] >= 0 && chain_[particle] != chain) is_joint_[particle] = 1;
      if (chain_[particle] >= 0) continue;
      chain_[particle] = chain;
      along_[particle] = place;
      of_rope_[particle] = 1;
    }
    along = end;
    thickest = std::max(thickest, segments[k].thickness);
  }
  for (const SelfFace& face : faces) {
    thickest = std::max(thickest, face.thickness);
    for (int particle : face.particles) {
      if (chain_[particle] >= 0) is_joint_[particle] = 1;
      of_rope_[particle] = 0;
    }
  }
  find_ways(segments, faces, rest, 2 * thickest);
}

void RopeRest::find_ways(const std::vector<SelfSegment>& segments, const std::vector<SelfFace>& faces,
                         const VecX& rest, double most) {
  near_.assign(chain_.size(), {});
  if (std::find(is_joint_.begin(), is_joint_.end(), 1) == is_joint_.end()) return;
  const std::vector<std::vector<int>> next = neighbours(segments, faces, chain_.size());
  int number = 0;
  for (std::size_t i = 0; i < is_joint_.size(); ++i)
    if (is_joint_[i] != 0) find_ways_from(number++, static_cast<int>(i), next, rest, most);
}

// [Dijkstra 1959]
void RopeRest::find_ways_from(int number, int particle, const std::vector<std::vector<int>>& next,
                              const VecX& rest, double most) {
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  open.emplace(0, particle);
  while (!open.empty()) {
    const auto [way, here] = open.top();
    open.pop();
    std::vector<Joint>& known = near_[here];
    if (!known.empty() && known.back().number == number) continue;
    known.push_back({number, way});
    for (const int there : next[here])
      if (const double farther = way + distance(rest, here, there); farther < most)
        open.emplace(farther, there);
  }
}

int RopeRest::one_of(const Encounter& e, bool second) const {
  const std::size_t cut = e.edges ? 2 : 1, first = second ? 3 : 0;
  if (!any()) return e.v[first];
  const std::size_t from = second ? cut : 0, to = second ? 4 : cut;
  int found = e.v[first];
  for (std::size_t k = from; k < to; ++k) {
    if (of_rope_[e.v[k]] == 0) continue;
    found = e.v[k];
    if (is_joint_[e.v[k]] == 0) break;
  }
  return found;
}

double RopeRest::way(const Encounter& e) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::size_t cut = e.edges ? 2 : 1;
  const int first = chain_[one_of(e, false)], second = chain_[one_of(e, true)];
  double least = infinity;
  if (first >= 0 && first == second) {
    double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
    for (std::size_t k = 0; k < 4; ++k) {
      if (chain_[e.v[k]] != first) continue;
      const std::size_t side = k < cut ? 0 : 1;
      low[side] = std::min(low[side], along_[e.v[k]]);
      high[side] = std::max(high[side], along_[e.v[k]]);
    }
    least = std::max({0.0, low[0] - high[1], low[1] - high[0]});
  }
  for (std::size_t k = 0; k < cut; ++k)
    for (std::size_t l = cut; l < 4; ++l)
      for (const Joint& a : near_[e.v[k]])
        for (const Joint& b : near_[e.v[l]])
          if (a.number == b.number) least = std::min(least, a.way + b.way);
  return least;
}

}  // namespace drape::internal
