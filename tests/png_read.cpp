#include "tests/png_read.h"

#include <cstring>
#include <stdexcept>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace drape::test {

using drawing::Image;

Image read_png(const std::string& bytes) {
  int width = 0, height = 0, channels = 0;
  unsigned char* rgb = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                                             static_cast<int>(bytes.size()), &width, &height, &channels, 3);
  if (!rgb) throw std::runtime_error(std::string("no PNG: ") + stbi_failure_reason());
  Image image(width, height, {});
  std::memcpy(image.pixels.data(), rgb, 3 * image.pixels.size());
  stbi_image_free(rgb);
  return image;
}

}  // namespace drape::test
