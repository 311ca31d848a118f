// Finds what is wrong with a pattern before it is meshed.
#pragma once

#include "mesh/pattern/sides.h"

namespace drape::internal {

// Throws InputError when there are no panels, when a name is given twice, or when a chain is broken, is not
// finite or has no area.
void check_pattern(const Pattern& pattern);

// Throws InputError when pieces of one panel cross or touch, or when panels overlap by more than the
// tolerance [m].
void check_pieces(const Pattern& pattern, const Sides& sides, double tolerance);

}  // namespace drape::internal
