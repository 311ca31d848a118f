// `drape triangulate`: a sewing pattern to a mesh, with a report.
#pragma once

#include <string>

namespace drape {

struct TriangulateWords {
  std::string pattern, out, edge, min_angle, tolerance;  // as the command line gives them; empty: not given
  bool quiet = false;
};

int triangulate_file(const TriangulateWords& words);

}  // namespace drape
