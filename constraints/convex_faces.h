// The flat faces of a convex body that is given as triangles.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::internal {

// n . x = offset is the plane of the face. No vertex of its triangles is beyond it.
struct ConvexFace {
  Vec3 normal;               // unit vector, out of the body
  double offset;             // m
  std::vector<int> corners;  // vertices of the mesh, counterclockwise as seen from outside
};

// The faces of a closed mesh that bulges everywhere. Triangles whose corners are within a millionth of the
// mesh's size of one plane are one face: a file of six digits leaves a flat side no flatter.
std::vector<ConvexFace> convex_faces(const TriangleMesh& mesh);

}  // namespace drape::internal
