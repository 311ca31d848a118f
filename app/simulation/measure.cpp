#include "app/simulation/measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/base/hash.h"

namespace drape::app {

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

}  // namespace drape::app
