// What a run reports of a state, beside what the step itself says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/simulation/simulation.h"

namespace drape {

// Largest relative stretch of an edge: max (l - L) / L; 0 when none is stretched.
double largest_strain(const std::vector<Cloth>& cloths, const VecX& x);

double max_speed(const VecX& v);  // m/s, of a particle

// FNV-1a, 64 bits, over the bytes of x and then v, as 16 hexadecimal digits:
// the same when every bit is the same.
std::string state_hash(const State& state);

struct Distribution {
  double median = 0, p95 = 0, max = 0, mean = 0;
};
Distribution distribution(std::vector<double> values);  // zeros when there are none

}  // namespace drape
