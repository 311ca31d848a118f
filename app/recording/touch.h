// Whether a vertex touches a body at the end of a step, as it is recorded.
#pragma once

#include <cstdint>

namespace drape::app {

enum class Touch : std::uint8_t { free = 0, slides = 1, sticks = 2 };

}  // namespace drape::app
