// The parts of the pages that were bundled from web/ when this program was built.
#pragma once

#include <string>
#include <string_view>

namespace drape::app {

// The page of `drape view` without its data. The text @@TITLE@@ (twice) and @@DATA@@ mark where these go.
std::string_view page_template();  // empty: the viewer is not in this build

// The style and script that draw the plots of compare.html; the script goes to the end of the page.
std::string_view plot_style(), plot_script();  // empty: the viewer is not in this build

std::string missing_viewer();  // why there is no viewer, and what to do

}  // namespace drape::app
