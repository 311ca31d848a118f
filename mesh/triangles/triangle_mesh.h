// The geometry of a cloth or a body: vertices and triangles, and the OBJ file that they came from.
//   positions  one per vertex, in the order of the file   [m]
//   triangles  three vertex numbers each, from 0
//   groups     named sets of vertices ('g' and 'o' in the OBJ file)
// The mesh knows no physics. Edges, diagonals, areas and the like are free functions
// (mesh/triangles/topology.h).
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

using Triangle = std::array<int, 3>;

struct VertexGroup {
  std::string name;
  std::vector<int> vertices;  // ascending, each once
};

struct ObjDocument;  // mesh/obj/obj.h: polygons, texture coordinates, materials, as they stood in the file

struct TriangleMesh {
  std::vector<Vec3> positions;                  // m
  std::vector<Triangle> triangles;              // vertex numbers
  std::vector<VertexGroup> groups;              // empty for generated meshes
  std::shared_ptr<const ObjDocument> document;  // null for generated meshes

  int vertex_count() const { return static_cast<int>(positions.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
};

}  // namespace drape
