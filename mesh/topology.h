// Edges, hinges, diagonals, boundaries, areas and pieces of a triangle mesh: free functions, each O(n log n).
// Deterministic: every list comes out sorted by vertex number, whatever the order of the triangles.
// Triangles that name a vertex twice are passed over; zero-area triangles take part in the topology.
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace drape {

struct Edge {
  int a, b;       // a < b
  int triangles;  // how many triangles share it: 1 on a boundary, 2 inside, more where non-manifold
};

// Two triangles that share the edge (a, b); c and d are the vertices opposite it.
struct Hinge {
  int a, b;  // a < b
  int c, d;  // c < d
};

// Two vertices that face each other across one or more edges [Noh & Jung, section 2]; a distinct pair, c < d.
struct Diagonal {
  int c, d;
};

std::vector<Edge> edges(const TriangleMesh& mesh);          // sorted by (a, b), each once
std::vector<Hinge> hinges(const TriangleMesh& mesh);        // sorted by (c, d, a, b); every pair of triangles of an edge
std::vector<Diagonal> diagonals(const TriangleMesh& mesh);  // sorted by (c, d), each pair once, c != d

// Closed walks along edges that have one triangle. Each loop starts at its lowest vertex; loops sorted by it.
std::vector<std::vector<int>> boundary_loops(const TriangleMesh& mesh);

double triangle_area(const TriangleMesh& mesh, const Triangle& t);   // m^2
std::vector<double> vertex_areas(const TriangleMesh& mesh);          // m^2, a third of every triangle around a vertex

// Piece number of every vertex (connected through triangles); a vertex without triangles is its own piece.
std::vector<int> connected_pieces(const TriangleMesh& mesh);

}  // namespace drape
