// Finds a regular grid of quads from the faces alone. The order of vertices and faces does not matter; the
// grid may have holes and slits, and may be closed to a tube.
//   regular  every face has four corners, every edge has one or two faces, and a vertex inside has four
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct QuadGrid {
  using Quad = std::array<int, 4>;  // the four vertices, in order round the face
  // Two quads that a line of the grid passes through one after the other, from vertex a by way of m to
  // vertex c. In a row, m is one end of the edge that the two quads share. On a diagonal, m is the only
  // vertex that they share.
  struct Straight {
    int a, m, c;         // a < c
    int quad_a, quad_c;  // the quad of a and the quad of c
  };

  std::vector<Quad> quads;
  std::vector<Straight> rows;       // each row twice where there are quads on both sides of it, else once
  std::vector<Straight> diagonals;  // each once
};

// Throws InputError that says where the mesh is not a regular grid.
QuadGrid quad_grid(const TriangleMesh& mesh);

}  // namespace drape
