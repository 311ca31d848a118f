// The only door to libpng.
#include <png.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "app/picture/image.h"

namespace drape::app::drawing {
namespace {

void append(png_structp writer, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(bytes), count);
}

void flush(png_structp) {}

[[noreturn]] void fail(png_structp, png_const_charp what) {
  throw std::runtime_error(std::string("the picture cannot be written as PNG: ") + what);
}

// The colours in order when there are 256 at most, else none.
std::vector<Pixel> table_of(const Image& image) {
  std::vector<Pixel> sorted;
  Pixel last{};
  for (const Pixel& pixel : image.pixels) {
    if (!sorted.empty() && pixel == last) continue;
    last = pixel;
    const auto place = std::lower_bound(sorted.begin(), sorted.end(), pixel);
    if (place != sorted.end() && *place == pixel) continue;
    if (sorted.size() == 256) return {};
    sorted.insert(place, pixel);
  }
  return sorted;
}

void write_rows(png_structp writer, const Image& image, const std::vector<Pixel>& table) {
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<png_byte> row(width * (table.empty() ? 3 : 1));
  for (int y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Pixel& pixel = image.at(static_cast<int>(x), y);
      if (table.empty())
        std::copy(pixel.begin(), pixel.end(), row.begin() + static_cast<std::ptrdiff_t>(3 * x));
      else
        row[x] = static_cast<png_byte>(std::lower_bound(table.begin(), table.end(), pixel) - table.begin());
    }
    png_write_row(writer, row.data());
  }
}

}  // namespace

std::string png(const Image& image) {
  std::string bytes;
  struct Writer {  // released when something throws, too
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    png_infop info = writer ? png_create_info_struct(writer) : nullptr;
    ~Writer() { png_destroy_write_struct(&writer, &info); }
  } file;
  if (!file.writer || !file.info) throw std::bad_alloc();
  png_set_write_fn(file.writer, &bytes, append, flush);
  png_set_compression_level(file.writer, 9);
  const std::vector<Pixel> table = table_of(image);
  png_set_IHDR(file.writer, file.info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8,
               table.empty() ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(file.writer, file.info, PNG_sRGB_INTENT_PERCEPTUAL);
  std::vector<png_color> colours;
  colours.reserve(table.size());
  for (const Pixel& p : table) colours.push_back({p[0], p[1], p[2]});
  if (!colours.empty())
    png_set_PLTE(file.writer, file.info, colours.data(), static_cast<int>(colours.size()));
  png_write_info(file.writer, file.info);
  write_rows(file.writer, image, table);
  png_write_end(file.writer, nullptr);
  return bytes;
}

}  // namespace drape::app::drawing
