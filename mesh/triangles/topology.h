// Edges, hinges, diagonals, boundaries, areas and connected pieces of a triangle mesh: free functions, O(n).
// Deterministic: every list is sorted by vertex number, whatever the order of the triangles. A triangle that
// names a vertex twice does not count. Several triangles with the same three vertices (in either direction)
// count once. Triangles without an area do count.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct Edge {
  int a, b;       // a < b
  int triangles;  // how many triangles share this edge: 1 on a boundary, 2 inside, more where non-manifold
  int forward;    // how many of those run from a to b; 1 where two triangles are wound consistently
};

// Two triangles that share the edge (a, b); c and d are the vertices opposite it.
struct Hinge {
  int a, b;    // a < b
  int c, d;    // c < d
  int tc, td;  // the triangle that has c and the triangle that has d
};

// Two different vertices, c < d, that are opposite each other across one or more edges
// [Noh & Jung, section 2].
struct Diagonal {
  int c, d;
};

// The numbers of the triangles that count, ascending; equal triangles count once, as the first of them.
std::vector<int> counted_triangles(const TriangleMesh& mesh);

std::vector<Edge> edges(const TriangleMesh& mesh);  // sorted by (a, b), each once
// Sorted by (c, d, a, b); one for every pair of triangles that share an edge.
std::vector<Hinge> hinges(const TriangleMesh& mesh);
std::vector<Diagonal> diagonals(const TriangleMesh& mesh);  // sorted by (c, d), each pair once

// Closed walks along the edges that have one triangle. A walk that meets itself is split there, so that no
// loop names a vertex twice. Each loop starts at its lowest vertex and runs in the direction of most of its
// triangles. The loops are sorted.
std::vector<std::vector<int>> boundary_loops(const TriangleMesh& mesh);

// For each vertex, the number of the first vertex at exactly the same place.
std::vector<int> welded(const std::vector<Vec3>& positions);

// The measures of a boundary loop. Vertices at exactly the same place count as one.
struct Hole {
  int edges;
  double circumference, width;  // m; the width is the diagonal of the loop's box
  Vec3 centre;                  // m, mean of the loop's vertices
};
std::vector<Hole> holes(const TriangleMesh& mesh);  // the widest first

double triangle_area(const TriangleMesh& mesh, const Triangle& t);  // m^2
// The area of each vertex [m^2]: a third of every triangle around it.
std::vector<double> vertex_areas(const TriangleMesh& mesh);
// The same, with the area of triangle k taken from triangle k of `rest`.
std::vector<double> vertex_areas(const TriangleMesh& mesh, const TriangleMesh& rest);

// The number of the connected piece to which each vertex belongs (connected through triangles). A vertex
// without triangles is a piece of its own. Pieces are numbered in the order of their lowest vertex.
std::vector<int> connected_pieces(const TriangleMesh& mesh);

}  // namespace drape
