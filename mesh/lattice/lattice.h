// Particles on the corners of equal cells that fill a box or a closed surface, and which of them are joined.
//   structural  along an edge of a cell: up to 6 neighbours
//   shear       along a diagonal, of a face or through a cell: up to 20
//   bend        the next but one along an axis, over two edges in line: up to 6
// A box of n x n x n particles has 3 n^2 (n-1), 6 n (n-1)^2 + 4 (n-1)^3 and 3 n^2 (n-2) of them: 2700, 7776
// and 2400 for n = 10.
// A surface is filled with all cells that it passes through or that have their centre inside, so that every
// point of it lies in a cell and is carried by its corners:
//   x = sum w_k x_k,  w_k = prod (t or 1 - t),  t in [0, 1]^3 the place in the cell:  exact for affine maps
// Particles and cells are numbered with x fastest, then y, then z.
#pragma once

#include <array>
#include <string>

#include "mesh/lattice/embedding.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// Two particles, and which part of the cells that could lie round the line between them does: 1 inside, 1/4
// for an edge of a box. (Of the next but one the less of its two edges.)
struct LatticePair {
  int i, j;
  double cells;
};

struct Lattice {
  Vec3 origin, spacing;         // m: the corner with the least coordinates, and the edges of a cell
  std::array<int, 3> cells;     // of the box round all
  std::vector<char> filled;     // cell -> it is there
  std::vector<int> particle;    // corner of the box of cells -> particle, -1: none
  std::vector<Vec3> positions;  // m, of the particles
  std::vector<double> volumes;  // m^3: an eighth of every cell round a particle
  std::vector<LatticePair> structural, shear, bend;

  int particle_count() const { return static_cast<int>(positions.size()); }
};

// So many particles along x, y, z, at least 2, centred on the origin.
Lattice box_lattice(const std::array<int, 3>& particles, const Vec3& spacing);

// Cubes of this edge [m]. Throws InputError where the surface is not closed; name stands in the message.
Lattice filled_lattice(const TriangleMesh& surface, double spacing, const std::string& name);

// About how many particles it would have, and how many corners its box of cells: before it is made.
struct LatticeSize {
  double particles, corners;
};
LatticeSize lattice_size(const TriangleMesh& surface, double spacing);

// Faces of cells without a neighbour there, as triangles, outwards. Vertices are the particles on them,
// ascending: particles says which.
TriangleMesh surface_of(const Lattice& lattice, std::vector<int>& particles);

// Points that the lattice carries, as it was made. What lies in no cell goes with the nearest. The lattice's
// particle 0 is `first`.
Embedding embedding_in(const Lattice& lattice, const std::vector<Vec3>& points, int first);

}  // namespace drape
