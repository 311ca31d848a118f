// The words of `drape picture` that need reading.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/picture/colours.h"

namespace drape::drawing {

// Throw InputError.
std::pair<int, int> size_named(const std::string& text);  // "1280x960"; empty: that
std::optional<Field> field_asked(const std::string& text);

// Frames from 0 of a run with `count` of them: "12", "1,5,last", "last", "all"; empty: the last one, or with
// `several` up to `several` spread over the run. `where` stands in messages.
std::vector<int> frames_named(const std::string& text, int count, int several, const std::string& where);

}  // namespace drape::drawing
