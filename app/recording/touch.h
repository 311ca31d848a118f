// What a vertex touches at the end of a step, as it is recorded. Of several, `stopped` counts most, then a
// body.
#pragma once

#include <array>
#include <cstdint>

namespace drape::app {

enum class Touch : std::uint8_t {
  free = 0,
  slides = 1,  // on a body
  sticks = 2,  // to a body
  cloth = 3,   // it touches cloth, and no body
  stopped = 4  // pushed or stopped on its way, so that nothing passes through cloth
};
inline constexpr std::array touch_names = {"free", "slides", "sticks", "on cloth", "stopped"};

}  // namespace drape::app
