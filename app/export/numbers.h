// Numbers as text, with the fewest digits that read back as the same float32; recordings hold float32.
#pragma once

#include <charconv>
#include <string>

namespace drape::app {

inline void append_text(std::string& text, double number) {
  char buffer[32];
  const float value = number == 0 ? 0.0f : static_cast<float>(number);  // no "-0"
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

}  // namespace drape::app
