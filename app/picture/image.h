// A picture as pixels, and as a PNG file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace drape::app::drawing {

using Pixel = std::array<std::uint8_t, 3>;  // sRGB

struct Image {
  int width = 0, height = 0;
  std::vector<Pixel> pixels;  // rows from the top

  Image(int w, int h, const Pixel& colour)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), colour) {}
  Pixel& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  const Pixel& at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
  bool has(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

// The bytes of a PNG file with 8 bits for each channel, marked as sRGB; with a palette where 256 colours are
// enough.
std::string png(const Image& image);

}  // namespace drape::app::drawing
