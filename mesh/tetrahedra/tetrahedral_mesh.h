// A body of tetrahedra, as plain data: vertices, tetrahedra, named sets of vertices.
//   V = (b - a) x (c - a) . (d - a) / 6, positive for a tetrahedron a b c d that is not inverted; its faces
//   with normals outwards are a c b, a b d, a d c and b c d.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

using Tetrahedron = std::array<int, 4>;

struct TetrahedralMesh {
  std::vector<Vec3> positions;          // m
  std::vector<Tetrahedron> tetrahedra;  // vertex numbers
  std::vector<VertexGroup> groups;

  int vertex_count() const { return static_cast<int>(positions.size()); }
};

double volume_of(const TetrahedralMesh& mesh, const Tetrahedron& t);  // m^3, signed
std::vector<double> vertex_volumes(
    const TetrahedralMesh& mesh);  // m^3: a quarter of every tetrahedron round it
std::vector<std::pair<int, int>> edges_of(
    const TetrahedralMesh& mesh);  // the lower vertex first; sorted, each once

// The faces that belong to one tetrahedron, with normals outwards, in the order of the tetrahedra. The
// vertices of the surface are those of its faces in ascending order, and `vertices` receives their numbers in
// the mesh. Groups have what lies on the surface; those that have nothing there are left out.
TriangleMesh surface_of(const TetrahedralMesh& mesh, std::vector<int>& vertices);

// Two tetrahedra that lie on the same side of a face that both have, or three that have one, so that they
// overlap: their numbers. {-1, -1} when there are none.
std::pair<int, int> overlapping(const TetrahedralMesh& mesh);

}  // namespace drape
