// The faces of a mesh as other formats want them: polygons where the file had polygons,
// uv by corner or by vertex, normals.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

using Uv = std::array<double, 2>;  // as in OBJ: v goes up

struct Faces {
  std::vector<int> counts;   // corners of each face
  std::vector<int> corners;  // vertex numbers, one face after the other
  std::vector<Uv> uv;        // of each corner; empty unless every corner has one
};

// The polygons of the document, or the triangles where there is none.
Faces faces_of(const TriangleMesh& mesh);

// uv of each vertex; empty when the faces have none, or a vertex has two. A vertex of no face has (0, 0).
std::vector<Uv> uv_by_vertex(const Faces& faces, std::size_t vertices);

// For formats with one uv and one normal a vertex: a vertex whose faces have several
// is doubled, after all the others.
struct Corners {
  std::vector<int> origin;  // vertex of the mesh that each one is; the first are the mesh's own
  std::vector<Uv> uv;       // of each; empty: none
  std::vector<Triangle> triangles;
  std::vector<int> normal;  // which normal each one has; those with one uv each may share it
  int normals = 0;          // how many there are

  std::size_t size() const { return origin.size(); }
};

// Edges of the mesh whose faces meet at more than `crease` [rad] are hard; pi: none is.
Corners split_corners(const TriangleMesh& mesh, const Faces& faces, double crease);

// Unit normals of each vertex of `corners`, weighted by area; positions are the mesh's. (0, 1,
// 0) where there is no face.
std::vector<Vec3> normals_of(const Corners& corners, const std::vector<Vec3>& positions);

// Bodies may have hard edges, such as those of a box; cloths have none.
inline double crease_of(bool body) { return body ? M_PI / 3 : M_PI; }

}  // namespace drape
