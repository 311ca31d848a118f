#include "app/view/page_blocks.h"

#include <zlib.h>

#include <new>
#include <stdexcept>

namespace drape::app {

std::string base64(std::string_view bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0u;
    };
    const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += letters[three >> 18];
    text += letters[three >> 12 & 63];
    text += i + 1 < bytes.size() ? letters[three >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? letters[three & 63] : '=';
  }
  return text;
}

std::string compressed(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), 6);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK) throw std::logic_error("zlib: " + std::to_string(status));
  out.resize(size);
  return out;
}

int PageBlocks::add(std::string_view bytes) {
  texts_.push_back(base64(compressed(bytes)));
  return static_cast<int>(texts_.size()) - 1;
}

std::string PageBlocks::html() const {
  std::size_t size = 0;
  for (const std::string& text : texts_) size += text.size() + 80;
  std::string html;
  html.reserve(size);
  for (std::size_t i = 0; i < texts_.size(); ++i)
    html += "<script type=\"text/plain\" id=\"drape-block-" + std::to_string(i) + "\">" + texts_[i] +
            "</script>\n";
  return html;
}

}  // namespace drape::app
