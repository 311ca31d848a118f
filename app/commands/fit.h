// `drape fit`: what a laboratory measured, as the parameters of a fabric in a file of their own. Only direct formulas
// (app/scene/laboratory.h); the file says of each number which formula it is from.
#pragma once

#include <string>

namespace drape::app {

struct FitWords {
  std::string out, from;  // fabric files; without `out` the new one is printed
  bool force = false;     // whether a file that is there is replaced
};

// Returns the exit code; throws InputError.
int fit(const FitWords& words);

}  // namespace drape::app
