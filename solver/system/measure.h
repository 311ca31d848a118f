// What is said of a state in a number or a word.
#pragma once

#include <string>

#include "solver/system/state.h"

namespace drape {

double max_speed(const VecX& v);  // m/s, of the fastest particle

// FNV-1a, 64 bits, over the bytes of x and then v, as 16 hexadecimal digits: the same when every bit is the
// same.
std::string state_hash(const State& state);

}  // namespace drape
