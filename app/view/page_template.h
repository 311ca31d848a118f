// What was bundled from web/ when this program was built.
#pragma once

#include <string>
#include <string_view>

namespace drape::app {

// The page of `drape view` without its data. Places in it: @@TITLE@@ (twice) and @@DATA@@.
std::string_view page_template();  // empty: the viewer is not in this build

// What draws the plots of compare.html; the script goes to the end of the page.
std::string_view plot_style(), plot_script();  // empty: the viewer is not in this build

std::string missing_viewer();  // why, and what to do

}  // namespace drape::app
