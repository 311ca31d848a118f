// `drape fit`: what a laboratory measured, as the parameters of a fabric in a file of their own. By direct
// formulas (app/scene/laboratory.h), and where there is none by virtual tests (app/textile/fitting.h). The
// file says of each number what it is from.
#pragma once

#include <string>

namespace drape::app {

struct FitWords {
  std::string out, from;  // fabric files; without `out` the new one is printed
  bool force = false;     // whether a file that is there is replaced
  // Of virtual tests; empty when not given.
  std::string mesh, repeats, parameters;
  bool quiet = false;  // nothing but errors, and the file where it is printed
};

// Returns the exit code: 0 done; 1 no parameters fit, with nothing written; 130 interrupted. Throws
// InputError.
int fit(const FitWords& words);

}  // namespace drape::app
