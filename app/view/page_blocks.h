// Blocks of bytes in a page: compressed (zlib), as text (base64), each an element with a number. A browser's
// script finds them by it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drape {

class PageBlocks {
 public:
  int add(std::string_view bytes);  // its number
  std::string html() const;         // all elements

 private:
  std::vector<std::string> texts_;
};

std::string base64(std::string_view bytes);
std::string compressed(std::string_view bytes);  // a zlib stream

}  // namespace drape
