// Text within HTML, SVG and XML.
#pragma once

#include <string>
#include <string_view>

namespace drape {

std::string escaped(std::string_view text);  // & < > "

}  // namespace drape
