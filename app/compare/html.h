// compare.html: the tables and plots of a comparison in one file that needs no other file and no network.
// Where the viewer is not in this build, a line says so in place of the plots.
#pragma once

#include "app/compare/comparison.h"
#include "app/compare/plot.h"

namespace drape::app {

std::vector<Plot> plots_of(const Comparison& comparison);
std::string compare_html(const Comparison& comparison);

}  // namespace drape::app
