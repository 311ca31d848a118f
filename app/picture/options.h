// Reads the options of `drape picture`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/picture/colours.h"

namespace drape::app::drawing {

// Both throw InputError.
std::pair<int, int> size_named(const std::string& text);  // "1280x960"; empty stands for that size
std::optional<Field> field_asked(const std::string& text);

// The frames that a text asks for, as numbers from 0, in a run with `count` frames. The text is "12" (in it
// frames count from 1), "1,5,last", "last" or "all". An empty text stands for the last frame or, if `several`
// is more than 1, for so many frames spread over the run. `where` stands in messages.
std::vector<int> frames_named(const std::string& text, int count, int several, const std::string& where);

}  // namespace drape::app::drawing
