// The page of `drape view` without its data, bundled from web/ when the program was built.
//   Places to fill in: @@TITLE@@ (twice) and @@DATA@@.
#pragma once

#include <string>
#include <string_view>

namespace drape {

std::string_view page_template();  // empty when this build has no viewer
std::string missing_viewer();      // says why, and what to do

}  // namespace drape
