#include "solver/matrix/locality_order.h"

#include <algorithm>

namespace drape::internal {
namespace {

// Searches breadth first from `root` and appends what it reaches to `order`, neighbours by rising degree,
// then by number.
void breadth_first(const Graph& g, int root, std::vector<char>& seen, std::vector<int>& order) {
  std::size_t head = order.size();
  order.push_back(root);
  seen[root] = 1;
  while (head < order.size()) {
    const int i = order[head++];
    const std::size_t first = order.size();
    for (int k = g.start[i]; k < g.start[i + 1]; ++k) {
      const int j = g.neighbour[k];
      if (seen[j]) continue;
      seen[j] = 1;
      order.push_back(j);
    }
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(),
              [&](int a, int b) { return g.degree(a) != g.degree(b) ? g.degree(a) < g.degree(b) : a < b; });
  }
}

}  // namespace

void LocalityOrder::find(const Graph& g, std::vector<int>& order) {
  const auto n = g.start.size() - 1;
  seen_.assign(n, 0);
  scratch_.assign(n, 0);
  order.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (seen_[i]) continue;
    int root = static_cast<int>(i);
    for (int round = 0; round < 2; ++round) {
      trial_.clear();
      breadth_first(g, root, scratch_, trial_);
      for (int t : trial_) scratch_[t] = 0;
      root = trial_.back();
    }
    breadth_first(g, root, seen_, order);
  }
  std::reverse(order.begin(), order.end());
}

}  // namespace drape::internal
