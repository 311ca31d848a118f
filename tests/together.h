// Several meshes as one, each a piece of its own.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::test {

inline TriangleMesh together(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const int first = all.vertex_count();
    all.positions.insert(all.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

}  // namespace drape::test
