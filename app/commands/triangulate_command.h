// `drape triangulate`: makes a mesh from a sewing pattern, and reports on it.
#pragma once

#include <string>

namespace drape::app {

struct TriangulateWords {
  std::string pattern, out, edge, min_angle, tolerance;  // as on the command line; empty when not given
  bool quiet = false;
};

// Returns the exit code; throws InputError.
int triangulate_file(const TriangulateWords& words);

}  // namespace drape::app
