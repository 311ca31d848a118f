// What lies at exactly one place. Layers of cloth, such as a fusing that was made by copying a panel: nothing
// tells which of them is over which, so the one that comes later is taken to lie farther out, along the
// normals. And vertices that edges of no length join: they are one point of the cloth.
#pragma once

#include <utility>
#include <vector>

#include "solver/assembly/cloth.h"

namespace drape::internal {

// For each vertex of the mesh, over how many other triangles one of its triangles lies: those of cloths and
// of the mesh that come before it, whose corners are at exactly the same places.
std::vector<int> layers_below(const std::vector<Cloth>& cloths, const TriangleMesh& mesh);

// Each vertex at exactly the place of another one, with the first vertex there.
std::vector<std::pair<int, int>> all_at_one_place(const TriangleMesh& mesh);
// How many triangles have their corners at the places of another one's, which has other vertices.
int triangles_on_others(const TriangleMesh& mesh);
// The pairs of vertices that an edge joins which has no length, neither as the cloth starts nor at rest:
// below 1e-9 of the size of each, as in mesh/obj/examine.h.
std::vector<std::pair<int, int>> joined_at_one_place(const TriangleMesh& mesh, const TriangleMesh& rest);

}  // namespace drape::internal
