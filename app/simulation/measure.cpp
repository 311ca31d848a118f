#include "app/simulation/measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/base/hash.h"

namespace drape {

double largest_strain(const std::vector<Cloth>& cloths, const VecX& x) {
  double largest = 0;
  for (const Cloth& cloth : cloths)
    for (const RestEdge& e : cloth.edges)
      largest = std::max(largest, (x.segment<3>(3 * e.j) - x.segment<3>(3 * e.i)).norm() / e.L - 1);
  return largest;
}

double max_speed(const VecX& v) {
  double squared = 0;
  for (Eigen::Index i = 0; i + 2 < v.size(); i += 3)
    squared = std::max(squared, v.segment<3>(i).squaredNorm());
  return std::sqrt(squared);
}

std::string state_hash(const State& state) { return Fnv1a().add_all(state.x).add_all(state.v).text(); }

Distribution distribution(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double fraction) {  // the nearest rank
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values.size())));
    return values[std::min(values.size(), std::max<std::size_t>(rank, 1)) - 1];
  };
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {at(0.5), at(0.95), values.back(), sum / static_cast<double>(values.size())};
}

}  // namespace drape
