// Blocks of bytes in a page: compressed (zlib) and written as text (base64), each in an element with a
// number, by which the script of the page finds it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drape::app {

class PageBlocks {
 public:
  int add(std::string_view bytes);  // returns the number of the block
  std::string html() const;         // all the elements

 private:
  std::vector<std::string> texts_;
};

std::string base64(std::string_view bytes);
std::string compressed(std::string_view bytes);  // a zlib stream

}  // namespace drape::app
