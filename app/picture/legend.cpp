#include "app/picture/legend.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/base/words.h"
#include "app/picture/text.h"

namespace drape::app::drawing {
namespace {

void fill(Image& image, int x0, int y0, int x1, int y1, const Pixel& colour) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (image.has(x, y)) image.at(x, y) = colour;
}

void draw_words(Image& image, const PixelBox& strip, const Scale& scale, int size) {
  const std::span<const char* const> names = words_of(scale.field);
  const std::vector<std::string> words(names.begin(), names.end());
  const int gap = size / 2, after = 3 * size / 2;
  int width = -after;
  for (const std::string& word : words) width += size + gap + text_width(word, size) + after;
  int x = static_cast<int>(strip.x + (strip.width - width) / 2);
  const int foot = static_cast<int>(strip.y + strip.height / 2) + size / 2;
  for (std::size_t k = 0; k < words.size(); ++k) {
    fill(image, x, foot - size + size / 8, x + size, foot + size / 8,
         colour_of(scale, static_cast<double>(k)));
    x += size + gap;
    draw_text(image, x, foot, words[k], size, Anchor::left, ink);
    x += text_width(words[k], size) + after;
  }
}

}  // namespace

void draw_legend(Image& image, const PixelBox& strip, const Scale& scale, double least, double largest,
                 int size) {
  if (!words_of(scale.field).empty()) return draw_words(image, strip, scale, size);
  const bool strain = scale.field == Field::strain;
  const double unit = strain ? 100 : 1;
  const std::string title = strain ? "strain, % (compressed to " + rounded(unit * least, 3) +
                                         ", stretched to " + rounded(unit * largest, 3) + ")"
                                   : "speed, m/s (largest " + rounded(unit * largest, 3) + ")";
  const int middle = static_cast<int>(strip.x + strip.width / 2);
  const int width = static_cast<int>(std::min(0.8 * strip.width, 26.0 * size)), left = middle - width / 2;
  const int top = static_cast<int>(strip.y) + 2 * size, bottom = top + std::max(4, 3 * size / 5);
  draw_text(image, middle, top - size / 2, title, size, Anchor::middle, ink);
  const auto value_at = [&](int x) { return scale.low + (x + 0.5) / width * (scale.high - scale.low); };
  for (int x = 0; x < width; ++x)
    fill(image, left + x, top, left + x + 1, bottom, colour_of(scale, value_at(x)));
  const double step = round_step(scale.high - scale.low, 4);
  const int first = static_cast<int>(std::ceil(scale.low / step - 1e-6));
  const int last = static_cast<int>(std::floor(scale.high / step + 1e-6));
  for (int k = first; k <= last; ++k) {
    const double share = (k * step - scale.low) / (scale.high - scale.low);
    const int x = left + static_cast<int>(std::lround(share * (width - 1)));
    fill(image, x, bottom, x + 1, bottom + std::max(2, size / 4), ink);
    draw_text(image, x, bottom + 3 * size / 2, rounded(unit * k * step, 6), size, Anchor::middle, ink);
  }
}

}  // namespace drape::app::drawing
