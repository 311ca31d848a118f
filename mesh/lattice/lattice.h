// A lattice: particles at the corners of equal cells that fill a box or a closed surface, and the pairs of
// particles that springs can join.
//   structural  along an edge of a cell: up to 6 neighbours
//   shear       along a diagonal of a face or of a cell: up to 20 neighbours
//   bend        the next particle but one along an axis, over two edges in line: up to 6 neighbours
// A box of n x n x n particles has 3 n^2 (n-1) structural, 6 n (n-1)^2 + 4 (n-1)^3 shear and 3 n^2 (n-2) bend
// pairs: 2700, 7776 and 2400 for n = 10.
// A closed surface is filled with all cells that it passes through or whose centre is inside it. So every
// point of the surface lies in a cell, and is carried by the corners x_k of that cell:
//   x = sum w_k x_k,  w_k = prod (t or 1 - t),  t in [0, 1]^3: the place in the cell.  Exact for affine maps.
// Particles and cells are numbered with x fastest, then y, then z.
#pragma once

#include <array>
#include <string>

#include "mesh/lattice/embedding.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// Two particles. `cells` is the filled fraction of the cells that could lie round the line between them: 1
// inside, 1/4 on an edge of a box. For a bend pair it is the smaller value of its two edges.
struct LatticePair {
  int i, j;
  double cells;
};

struct Lattice {
  Vec3 origin, spacing;         // m: the corner with the least coordinates, and the edge lengths of a cell
  std::array<int, 3> cells;     // number of cells along x, y, z of the whole box
  std::vector<char> filled;     // for each cell of the box, whether it belongs to the lattice
  std::vector<int> particle;    // for each corner of the cells of the box, its particle, or -1
  std::vector<Vec3> positions;  // of the particles, m
  std::vector<double> volumes;  // m^3, of each particle: an eighth of every filled cell round it
  std::vector<LatticePair> structural, shear, bend;

  int particle_count() const { return static_cast<int>(positions.size()); }
};

// A full box with this many particles along x, y, z (at least 2 each), centred on the origin; `spacing` in m.
Lattice box_lattice(const std::array<int, 3>& particles, const Vec3& spacing);

// Fills a closed surface with cubes of edge `spacing` [m]. Throws InputError when the surface is not closed;
// `name` stands in the message.
Lattice filled_lattice(const TriangleMesh& surface, double spacing, const std::string& name);

// The size of a filled lattice before it is made: an estimate of the number of particles, and the number of
// corners in the box of cells round it.
struct LatticeSize {
  double particles, corners;
};
LatticeSize lattice_size(const TriangleMesh& surface, double spacing);

// The faces of filled cells that have no filled cell beyond them, as triangles with normals outwards. The
// vertices of the mesh are the particles on those faces in ascending order; `particles` receives their
// numbers.
TriangleMesh surface_of(const Lattice& lattice, std::vector<int>& particles);

// Attaches points [m] to the lattice in its rest positions. A point that lies in no filled cell is attached
// to the nearest one. `first` is the number of the lattice's particle 0 in the embedding.
Embedding embedding_in(const Lattice& lattice, const std::vector<Vec3>& points, int first);

}  // namespace drape
