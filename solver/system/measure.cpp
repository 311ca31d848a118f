#include "solver/system/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace drape {
namespace {

std::uint64_t fnv1a(std::uint64_t hash, const VecX& numbers) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  const std::size_t count = static_cast<std::size_t>(numbers.size()) * sizeof(double);
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
  return hash;
}

}  // namespace

double max_speed(const VecX& v) {
  double squared = 0;
  for (Eigen::Index i = 0; i + 2 < v.size(); i += 3)
    squared = std::max(squared, v.segment<3>(i).squaredNorm());
  return std::sqrt(squared);
}

std::string state_hash(const State& state) {
  char text[17];
  const std::uint64_t hash = fnv1a(fnv1a(14695981039346656037u, state.x), state.v);
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace drape
