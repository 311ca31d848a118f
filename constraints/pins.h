// Rules that choose the vertices of a cloth that are held: by number, by a box in space, by a group of the
// OBJ file, or as the end of a rope.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct PinVertices {
  std::vector<int> vertices;  // counted from 0
};
struct PinBox {
  Vec3 lower, upper;  // corners of the box [m]; they belong to it
};
struct PinGroup {
  std::string name;
};
struct PinEnd {
  bool last = false;  // of a line of vertices, such as a rope: its last vertex, or its first
};
using PinRule = std::variant<PinVertices, PinBox, PinGroup, PinEnd>;

// Returns the vertices that the rule selects, ascending. Throws InputError when there are none; the message
// names what there is to choose from.
std::vector<int> select(const PinRule& rule, const TriangleMesh& mesh);

}  // namespace drape
