// Edges, hinges, diagonals, boundaries, areas and pieces of a triangle mesh: free functions, O(n).
// Deterministic: every list comes out sorted by vertex number, whatever the order of the triangles.
// Which triangles count: one that names a vertex twice is passed over; several of the same three vertices
// (either way round) count once; zero-area triangles take part.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct Edge {
  int a, b;       // a < b
  int triangles;  // how many triangles share it: 1 on a boundary, 2 inside, more where non-manifold
  int forward;    // how many of them run from a to b; consistently wound: forward = 1 where triangles = 2
};

// Two triangles that share the edge (a, b); c and d are the vertices opposite it.
struct Hinge {
  int a, b;    // a < b
  int c, d;    // c < d
  int tc, td;  // the triangles of c and of d
};

// Two vertices that face each other across one or more edges [Noh & Jung, section 2]; a distinct pair, c < d.
struct Diagonal {
  int c, d;
};

// Numbers of the triangles that count, ascending; of equal ones the first.
std::vector<int> counted_triangles(const TriangleMesh& mesh);

std::vector<Edge> edges(const TriangleMesh& mesh);  // sorted by (a, b), each once
// Sorted by (c, d, a, b); every pair of triangles of an edge.
std::vector<Hinge> hinges(const TriangleMesh& mesh);
std::vector<Diagonal> diagonals(const TriangleMesh& mesh);  // sorted by (c, d), each pair once, c != d

// Closed walks along edges that have one triangle; a walk that meets itself is split there, so that no loop
// names a vertex twice. Each loop starts at its lowest vertex and runs the way most of its triangles do;
// loops are sorted.
std::vector<std::vector<int>> boundary_loops(const TriangleMesh& mesh);

// For each vertex the first one at exactly the same place.
std::vector<int> welded(const std::vector<Vec3>& positions);

// A boundary loop, measured. Vertices at exactly the same place count as one.
struct Hole {
  int edges;
  double circumference, width;  // m; width: the diagonal of its box
  Vec3 centre;                  // m, mean of its vertices
};
std::vector<Hole> holes(const TriangleMesh& mesh);  // the widest first

double triangle_area(const TriangleMesh& mesh, const Triangle& t);  // m^2
// m^2, a third of every triangle around a vertex.
std::vector<double> vertex_areas(const TriangleMesh& mesh);
// The same where triangle k of the mesh has the area of the rest's triangle k.
std::vector<double> vertex_areas(const TriangleMesh& mesh, const TriangleMesh& rest);

// Piece number of every vertex (connected through triangles); a vertex without triangles is its own piece.
// Pieces are numbered by their lowest vertex.
std::vector<int> connected_pieces(const TriangleMesh& mesh);

}  // namespace drape
