// The page of `drape view` without its data, as bundled from web/ when this program was built.
//   Places in it: @@TITLE@@ (twice) and @@DATA@@.
#pragma once

#include <string>
#include <string_view>

namespace drape {

std::string_view page_template();  // empty: the viewer is not in this build
std::string missing_viewer();      // why, and what to do

}  // namespace drape
