// `drape triangulate`: a sewing pattern to a mesh, with a report.
#pragma once

#include <string>

#include "app/words.h"
#include "mesh/pattern.h"

namespace drape {

struct TriangulateWords {
  std::string pattern, out, edge, min_angle, tolerance;  // as the command line gives them; empty: not given
  bool quiet = false;
};

// Notes and warnings about the triangles of a mesh: corners and triangles below the bound [rad]. `where`: the
// pattern.
Names remarks(const PatternMesh& made, double min_angle, const std::string& where);

int triangulate_file(const TriangulateWords& words);

}  // namespace drape
