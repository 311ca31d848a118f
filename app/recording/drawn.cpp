#include "app/recording/drawn.h"

#include "mesh/triangles/line.h"

namespace drape::app {

DrawnShape::DrawnShape(const RecordedShape& shape)
    : radius_(shape.mesh.triangles.empty() ? shape.radius : 0),
      triangles_(is_tube() ? tube_triangles(shape.mesh.vertex_count(), tube_sides) : shape.mesh.triangles) {}

std::vector<Vec3> DrawnShape::positions(std::vector<Vec3> own) const {
  return is_tube() ? tube_positions(own, radius_, tube_sides) : std::move(own);
}

}  // namespace drape::app
