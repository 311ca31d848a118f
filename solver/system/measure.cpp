#include "solver/system/measure.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/hash.h"

namespace drape {

double max_speed(const VecX& v) {
  double squared = 0;
  for (Eigen::Index i = 0; i + 2 < v.size(); i += 3)
    squared = std::max(squared, v.segment<3>(i).squaredNorm());
  return std::sqrt(squared);
}

std::string state_hash(const State& state) { return Fnv1a().add_all(state.x).add_all(state.v).text(); }

}  // namespace drape
