// Quantities of a state that a run reports beside the report of the step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/simulation/simulation.h"

namespace drape {

// The largest relative stretch of an edge, max (l - L) / L; 0 when no edge is stretched.
double largest_strain(const std::vector<Cloth>& cloths, const VecX& x);

double max_speed(const VecX& v);  // m/s, of the fastest particle

// FNV-1a hash (64 bits) of the bytes of x and then v, as 16 hexadecimal digits. Equal bits give equal hashes.
std::string state_hash(const State& state);

// p95 is the 95th percentile. Percentiles are values that occur (nearest rank).
struct Distribution {
  double median = 0, p95 = 0, max = 0, mean = 0;
};
Distribution distribution(std::vector<double> values);  // all zero when there are no values

}  // namespace drape
