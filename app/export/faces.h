// The faces of a mesh in the forms that other formats need: polygons where the OBJ file had polygons, uv by
// corner or by vertex, normals.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::app {

using Uv = std::array<double, 2>;  // as in OBJ, v goes up

struct Faces {
  std::vector<int> counts;   // number of corners of each face
  std::vector<int> corners;  // vertex numbers, one face after the other
  std::vector<Uv> uv;        // of each corner; empty unless every corner has uv
  std::vector<int> line;     // of a rope, which has no faces: its vertices in order; empty for all others
};

// The polygons of the document, or the triangles when there is no document.
Faces faces_of(const TriangleMesh& mesh);

// uv of each vertex; empty when the faces have none, or a vertex has two. A vertex without faces gets (0, 0).
std::vector<Uv> uv_by_vertex(const Faces& faces, std::size_t vertices);

// Vertices for formats with one uv and one normal for each vertex. A vertex whose faces have several is
// doubled; the copies come after all the others.
struct Corners {
  // For each of these vertices, the vertex of the mesh of which it is a copy. The mesh's own vertices come
  // first, in their order.
  std::vector<int> origin;
  std::vector<Uv> uv;  // of each; empty when there are none
  std::vector<Triangle> triangles;
  std::vector<int> normal;  // number of the normal of each; copies that differ in uv only may share a normal
  int normals = 0;          // number of different normals

  std::size_t size() const { return origin.size(); }
};

// Edges of the mesh whose faces meet at more than `crease` [rad] are hard; with pi no edge is.
Corners split_corners(const TriangleMesh& mesh, const Faces& faces, double crease);

// Unit normals of each vertex of `corners`, weighted by area, or (0, 1, 0) where there is no face; positions
// are those of the mesh's vertices.
std::vector<Vec3> normals_of(const Corners& corners, const std::vector<Vec3>& positions);

// Bodies may have hard edges, such as the edges of a box. Cloths have none.
inline double crease_of(bool body) { return body ? M_PI / 3 : M_PI; }

}  // namespace drape::app
