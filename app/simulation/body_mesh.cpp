#include "app/simulation/body_mesh.h"

namespace drape::app {

TriangleMesh present_mesh(const MovingBody& body, double time) {
  TriangleMesh mesh = mesh_of(body.obstacle().shape);
  if (const DeformingBody* const deformed = deforming(body.obstacle().shape))
    deformed->frames->positions_at(time, mesh.positions);
  for (Vec3& x : mesh.positions) x = body.pose().to_world(x);
  return mesh;
}

}  // namespace drape::app
