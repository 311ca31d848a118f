// What holds a soft body of an assembly together.
#pragma once

#include "solver/assembly/cloth.h"

namespace drape::internal {

// Its springs, or its clusters. Throws InputError when its material does not suit what it is made of.
std::vector<std::unique_ptr<Force>> soft_forces(const Cloth& soft);

}  // namespace drape::internal
