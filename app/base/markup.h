// Makes a text safe to stand within HTML, SVG or XML.
#pragma once

#include <string>
#include <string_view>

#include "app/base/json.h"

namespace drape::app {

std::string escaped(std::string_view text);  // replaces & < > "
// In one line. No '<' is left: nothing in it can end the element it stands in.
std::string json_for_html(const Json& json);

}  // namespace drape::app
