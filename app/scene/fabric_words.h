// What a fabric is made of, in words for people.
#pragma once

#include <string>

#include "app/scene/fabrics.h"

namespace drape::app {

// "135.2 g/m^2, stretch 500 N/m, shear 41 N/m, bend 1.95 / 0.61 uN.m"; of two numbers the first is along the
// warp, the second along the weft.
std::string in_words(const Fabric& fabric);

// The same for a model of springs, which takes the means of warp and weft.
std::string mean_in_words(const Fabric& fabric);

// What models of springs leave out of it: "shear, Poisson's ratio"; empty: nothing.
std::string beyond_springs(const Fabric& fabric);

// What was given in other words, and what is only recorded, a line each.
Names lines_of(const FabricRecord& record);

}  // namespace drape::app
