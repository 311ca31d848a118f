// The legend of a picture, which explains its colours: a bar with round ticks, or a square for each word.
#pragma once

#include <string>

#include "app/picture/camera.h"
#include "app/picture/colours.h"

namespace drape::app::drawing {

inline constexpr double legend_lines = 4.4;  // height of the legend over the size of its letters

// Draws the legend into the middle of the strip. `size` [pixels] is that of the letters; `least` and
// `largest` are the most extreme values that occur, 0 included.
void draw_legend(Image& image, const PixelBox& strip, const Scale& scale, double least, double largest,
                 int size);

}  // namespace drape::app::drawing
