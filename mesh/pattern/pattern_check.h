// What is wrong with a pattern before it can be meshed. Internal to the library (not installed).
#pragma once

#include "mesh/pattern/sides.h"

namespace drape::internal {

// Throws InputError: no panels, names given twice, chains that are broken, not finite or without an area.
void check_pattern(const Pattern& pattern);

// Throws InputError: pieces of one panel that cross or touch, panels that overlap by more than the tolerance.
void check_pieces(const Pattern& pattern, const Sides& sides, double tolerance);

}  // namespace drape::internal
