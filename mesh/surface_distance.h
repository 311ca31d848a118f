// Signed distance from a point to a triangle surface.
//   closed     negative inside; sign by the angle-weighted pseudo-normal of the closest feature
//              [Baerentzen & Aanaes 2005, Signed distance computation using the angle weighted pseudonormal]
//   otherwise  a thick surface: never negative, the normal points from the surface to the point
//
// Closed: every edge has two triangles and the surface two sides. Each connected piece is wound outwards on
// its own, so that the inner wall of a hollow body counts as a second body.
//
// The tree is embree's; distances are computed in double precision by us, and ties go to the lowest triangle
// number, so the answer does not depend on the tree or on the processor.
#pragma once

#include <memory>

#include "mesh/triangle_mesh.h"

namespace drape {

struct SurfacePoint {
  double distance;  // m, negative inside
  Vec3 normal;      // unit, gradient of the distance: outwards
};

class SurfaceDistance {
 public:
  explicit SurfaceDistance(const TriangleMesh& mesh);  // throws InputError when no triangle has an area
  ~SurfaceDistance();
  SurfaceDistance(const SurfaceDistance&) = delete;
  SurfaceDistance& operator=(const SurfaceDistance&) = delete;

  SurfacePoint closest(const Vec3& x) const;  // safe to call from several threads
  bool closed() const;
  bool inside_out() const;  // closed, but wound with normals inwards (it is turned round on construction)
  const TriangleMesh& mesh() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace drape
