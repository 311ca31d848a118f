// Choosing the vertices of a cloth that are held: by number, by a box in space, by a group of the OBJ file.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct PinVertices {
  std::vector<int> vertices;  // from 0
};
struct PinBox {
  Vec3 lower, upper;  // m, corners included
};
struct PinGroup {
  std::string name;
};
using PinRule = std::variant<PinVertices, PinBox, PinGroup>;

// The vertices the rule selects, ascending. Throws InputError when it selects nothing, naming what there is
// to choose from.
std::vector<int> select(const PinRule& rule, const TriangleMesh& mesh);

}  // namespace drape
