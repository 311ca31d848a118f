#include "mesh/lattice/embedding.h"

#include <algorithm>

namespace drape {

Embedding Embedding::each(int first, int vertices) {
  Embedding all;
  all.start_.reserve(static_cast<std::size_t>(vertices) + 1);
  all.shares_.reserve(static_cast<std::size_t>(vertices));
  for (int v = 0; v < vertices; ++v) {
    all.shares_.push_back({first + v, 1.0});
    all.start_.push_back(all.shares_.size());
  }
  return all;
}

void Embedding::add_vertex(const std::vector<Share>& shares) {
  shares_.insert(shares_.end(), shares.begin(), shares.end());
  start_.push_back(shares_.size());
}

int Embedding::particle(int vertex) const {
  const std::size_t begin = start_[vertex];
  const bool alone = start_[vertex + 1] == begin + 1;
  return alone ? shares_[begin].particle : -1;
}

int Embedding::vertex(int particle) const {
  const auto share = std::find_if(shares_.begin(), shares_.end(),
                                  [&](const Share& s) { return s.particle == particle && s.weight != 0; });
  if (share == shares_.end()) return -1;
  const auto at = static_cast<std::size_t>(share - shares_.begin());
  return static_cast<int>(std::upper_bound(start_.begin(), start_.end(), at) - start_.begin()) - 1;
}

void Embedding::renumber(const std::vector<int>& number) {
  for (Share& share : shares_) share.particle = number[share.particle];
}

std::vector<Vec3> Embedding::positions(const VecX& x) const {
  std::vector<Vec3> all(start_.size() - 1, Vec3::Zero());
  for (std::size_t v = 0; v < all.size(); ++v) {
    const std::size_t begin = start_[v], end = start_[v + 1];
    if (end == begin + 1) {  // one particle: its position to the last bit
      all[v] = x.segment<3>(3 * shares_[begin].particle);
      continue;
    }
    for (std::size_t k = begin; k < end; ++k)
      all[v] += shares_[k].weight * x.segment<3>(3 * shares_[k].particle);
  }
  return all;
}

}  // namespace drape
