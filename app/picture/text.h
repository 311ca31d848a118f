// Words on a picture, in DejaVu Sans, which the program carries with it.
#pragma once

#include <string_view>

#include "app/picture/image.h"

namespace drape::drawing {

enum class Anchor { left, middle, right };

// Pixels from the first letter to the end of the last one; size: of the font, pixels.
int text_width(std::string_view utf8, int size);

// On the line y (the foot of the letters), beginning, centred or ending at x.
void draw_text(Image& image, int x, int y, std::string_view utf8, int size, Anchor anchor,
               const Pixel& colour);

}  // namespace drape::drawing
