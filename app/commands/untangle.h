// `drape untangle`: brings a mesh apart where it passes through itself (constraints/tangles.h).
#pragma once

#include <string>

#include "mesh/base/words.h"

namespace drape::app {

struct UntangleWords {
  std::string mesh, out, fabric = "cotton-poplin";
  std::string scale, thickness, duration;  // as on the command line; empty when not given
  Names layers;                            // groups of the mesh, from the inside out
  bool weld = false;                       // vertices at one place are joined
  bool quiet = false;
};

// Returns the exit code: 0 when nothing crosses any more, 1 when something still does or a step failed, 130
// when it was interrupted; the mesh is written in all of these cases. Throws InputError.
int untangle_file(const UntangleWords& words);

}  // namespace drape::app
