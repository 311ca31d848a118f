// Measures of a state: a number or a word for each.
#pragma once

#include <string>

#include "solver/system/state.h"

namespace drape {

double max_speed(const VecX& v);  // m/s, of the fastest particle

// The FNV-1a hash of 64 bits over the bytes of x and then v, as 16 hexadecimal digits. Two states have the
// same hash when all their bits are the same.
std::string state_hash(const State& state);

}  // namespace drape
