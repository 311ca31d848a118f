// Which face of the file a triangle is from, and in which groups it is.
#pragma once

#include <string>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::internal {

// For every triangle of the mesh the number of its face in the mesh's document, from 0.
std::vector<std::size_t> faces_of_triangles(const TriangleMesh& mesh);

// The triangles, ascending, whose faces stand under this name in the file ('g' or 'o'). A mesh without a
// document has those whose corners are all in the group.
std::vector<int> triangles_of_group(const TriangleMesh& mesh, const std::string& name);

}  // namespace drape::internal
