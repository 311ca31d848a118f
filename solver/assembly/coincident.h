// Layers of cloth that lie at exactly one place, such as a fusing that was made by copying a panel. Nothing tells which of them
// is over which, so the one that comes later is taken to lie farther out, along the normals.
#pragma once

#include <vector>

#include "solver/assembly/cloth.h"

namespace drape::internal {

// For each vertex of the mesh, over how many other triangles one of its triangles lies: those of cloths and of the mesh
// that come before it, whose corners are at exactly the same places.
std::vector<int> layers_below(const std::vector<Cloth>& cloths, const TriangleMesh& mesh);

}  // namespace drape::internal
