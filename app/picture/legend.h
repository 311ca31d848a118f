// What the colours of a picture mean: a bar with round ticks, or a square for each word.
#pragma once

#include <string>

#include "app/picture/camera.h"
#include "app/picture/colours.h"

namespace drape::drawing {

inline constexpr double legend_lines = 4.4;  // its height over the size of its letters

// In the middle of the strip; size: of the letters, pixels. largest: the value of what is farthest out.
void draw_legend(Image& image, const PixelBox& strip, const Scale& scale, double largest, int size);

}  // namespace drape::drawing
