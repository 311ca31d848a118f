// compare.html: the tables and plots of a comparison in one file that loads nothing else, not
// from the network either.
#pragma once

#include "app/compare/comparison.h"
#include "app/compare/plot.h"

namespace drape {

std::vector<Plot> plots_of(const Comparison& comparison);
std::string compare_html(const Comparison& comparison);

}  // namespace drape
