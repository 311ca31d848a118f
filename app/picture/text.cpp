// The only door to FreeType.
#include "app/picture/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <cstdint>
#include <memory>
#include <stdexcept>

extern "C" {  // app/picture/font.cmake makes it from a font file
extern const unsigned char drape_font[];
extern const unsigned drape_font_bytes;
}

namespace drape::app::drawing {
namespace {

class Font {
 public:
  Font() {
    if (FT_Init_FreeType(&library_) != 0) throw std::runtime_error("FreeType does not start");
    if (FT_New_Memory_Face(library_, drape_font, static_cast<FT_Long>(drape_font_bytes), 0, &face_) != 0) {
      FT_Done_FreeType(library_);
      throw std::runtime_error("FreeType cannot read the font of the program");
    }
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;
  ~Font() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }

  // f(glyph, x) of each letter, x its place along the line; returns the length of the line.
  template <class F>
  int set(std::string_view utf8, int size, const F& f) {
    FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(size));
    int x = 0;
    while (!utf8.empty()) {
      if (FT_Load_Char(face_, next(utf8), FT_LOAD_RENDER) != 0) continue;
      f(*face_->glyph, x);
      x += static_cast<int>(face_->glyph->advance.x >> 6);
    }
    return x;
  }

 private:
  // The first letter, taken off; a byte that is not UTF-8 is a question mark.
  static FT_ULong next(std::string_view& utf8) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(utf8[i]); };
    const std::size_t more = byte(0) < 0x80 ? 0 : byte(0) >> 5 == 6 ? 1 : byte(0) >> 4 == 14 ? 2 : 3;
    FT_ULong letter = more == 0 ? byte(0) : byte(0) & (0x3FU >> more);
    bool valid = more < utf8.size() && (more == 0 || byte(0) >= 0xC2) && byte(0) < 0xF5;
    for (std::size_t i = 1; valid && i <= more; ++i) {
      valid = byte(i) >> 6 == 2;
      letter = letter << 6 | (byte(i) & 0x3FU);
    }
    utf8.remove_prefix(valid ? more + 1 : 1);
    return valid ? letter : '?';
  }

  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

Font& font() {
  static Font the_font;
  return the_font;
}

}  // namespace

int text_width(std::string_view utf8, int size) {
  return font().set(utf8, size, [](const FT_GlyphSlotRec&, int) {});
}

void draw_text(Image& image, int x, int y, std::string_view utf8, int size, Anchor anchor,
               const Pixel& colour) {
  if (anchor != Anchor::left) x -= text_width(utf8, size) / (anchor == Anchor::middle ? 2 : 1);
  font().set(utf8, size, [&](const FT_GlyphSlotRec& glyph, int along) {
    const FT_Bitmap& letter = glyph.bitmap;
    for (int row = 0; row < static_cast<int>(letter.rows); ++row)
      for (int column = 0; column < static_cast<int>(letter.width); ++column) {
        const int px = x + along + glyph.bitmap_left + column, py = y - glyph.bitmap_top + row;
        if (!image.has(px, py)) continue;
        const int ink = letter.buffer[row * letter.pitch + column];
        Pixel& pixel = image.at(px, py);
        for (std::size_t k = 0; k < 3; ++k)
          pixel[k] = static_cast<std::uint8_t>((pixel[k] * (255 - ink) + colour[k] * ink + 127) / 255);
      }
  });
}

}  // namespace drape::app::drawing
