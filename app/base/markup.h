// Makes a text safe to stand within HTML, SVG or XML.
#pragma once

#include <string>
#include <string_view>

namespace drape {

std::string escaped(std::string_view text);  // replaces & < > "

}  // namespace drape
