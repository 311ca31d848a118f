// Writes words into a picture, in DejaVu Sans; the font is part of the program.
#pragma once

#include <string_view>

#include "app/picture/image.h"

namespace drape::app::drawing {

enum class Anchor { left, middle, right };

// Width in pixels from the first letter to the end of the last one; size: of the font, pixels.
int text_width(std::string_view utf8, int size);

// Draws a line of text whose letters stand on y and which begins, is centred or ends at x.
void draw_text(Image& image, int x, int y, std::string_view utf8, int size, Anchor anchor,
               const Pixel& colour);

}  // namespace drape::app::drawing
