// The faces of a mesh as other formats want them: polygons where the file had polygons, uv by corner or by
// vertex, normals.
#pragma once

#include <array>
#include <vector>

#include "mesh/triangle_mesh.h"

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

// For formats with one uv a vertex: a vertex whose faces disagree is doubled, after all the others.
struct Corners {
  std::vector<int> origin;  // vertex of the mesh that each one is; the first are the mesh's own
  std::vector<Uv> uv;       // of each; empty: none
  std::vector<Triangle> triangles;
};
Corners split_by_uv(const TriangleMesh& mesh, const Faces& faces);

// Unit normals, weighted by area; (0, 1, 0) where there is no face.
std::vector<Vec3> vertex_normals(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions);

}  // namespace drape
