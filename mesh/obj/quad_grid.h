// A regular grid of quads, found from the faces alone: whatever the order of vertices and faces, with holes,
// closed to a tube or not.
//   regular  every face has four corners, an edge has one or two of them, and every vertex inside has four
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct QuadGrid {
  using Quad = std::array<int, 4>;  // vertices, going round
  // Two quads that a line of the grid goes through one after the other: a -> m -> c. Along a row m is one
  // end of the edge that they share; along a diagonal they meet in m only.
  struct Straight {
    int a, m, c;         // a < c
    int quad_a, quad_c;  // that of a and that of c
  };

  std::vector<Quad> quads;
  std::vector<Straight> rows;       // one entry for each side of the row where there are quads: one or two
  std::vector<Straight> diagonals;  // each once
};

// Throws InputError that says where the mesh is no regular grid.
QuadGrid quad_grid(const TriangleMesh& mesh);

}  // namespace drape
