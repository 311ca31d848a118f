// Makes a text safe to stand within HTML, SVG or XML.
#pragma once

#include <string>
#include <string_view>

#include "app/base/json.h"

namespace drape::app {

std::string escaped(std::string_view text);  // replaces & < > "
// The JSON in one line. It contains no '<', so nothing in it can end the element in which it stands.
std::string json_for_html(const Json& json);

}  // namespace drape::app
