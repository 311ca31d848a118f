// A triangle mesh that is cut along some of its edges.
//   Triangles go on sharing a corner as long as a way of edges that are not cut joins them round the vertex.
//   Where the triangles round a vertex fall into several fans by this, each fan gets a vertex of its own: the
//   fan with the lowest triangle number keeps the vertex, the others get copies of it. So a cut that ends
//   inside the mesh keeps one vertex at its tip (one inner edge by itself parts nothing, two in line do), and
//   all triangles at a cut edge that three or more share part from each other. A cut edge of the border parts
//   nothing.
//   At vertices of no cut edge nothing changes, also where a mesh hangs together by such a vertex alone.
// Number, order, corners' places and areas of the triangles stay as they are. Equal triangles stay together,
// and triangles that name a vertex twice stay as they are. Vertices keep their numbers; the copies come after
// them, in the order of the vertices that they are copies of.
#pragma once

#include <utility>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

using CutEdge = std::pair<int, int>;  // its two vertices, in either order

struct TornTriangles {
  std::vector<Triangle> triangles;  // triangle k is triangle k of the mesh
  std::vector<int> copy_of;         // vertex n + k is a copy of vertex copy_of[k]; n: vertices of the mesh
};

// Throws InputError when a cut is no edge of the mesh.  O(n log n) for n triangles.
TornTriangles torn_triangles(const TriangleMesh& mesh, const std::vector<CutEdge>& cuts);

// A mesh of which several vertices may be one thing, such as a particle that was sewn of them, after those
// things were cut: parts[t][k] is what corner k of triangle t belongs to. Each vertex belongs to one part:
// where its corners fall to several,
// the part of the lowest triangle keeps the vertex, and the others get copies of it.  O(n log n).
TornTriangles divided_triangles(const TriangleMesh& mesh, const std::vector<Triangle>& parts);

}  // namespace drape
