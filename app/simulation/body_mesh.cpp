#include "app/simulation/body_mesh.h"

#include <Eigen/Geometry>
#include <utility>

#include "mesh/triangles/generate.h"

namespace drape {
namespace {

constexpr int fineness = 4;  // subdivisions of a sphere
constexpr int around = 96;   // vertices

TriangleMesh placed(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& x : mesh.positions) x = pose.to_world(x);
  return mesh;
}

// The turn that takes +y, along which a shape is generated, to `direction`.
Mat3 from_y_to(const Vec3& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), direction).toRotationMatrix();
}

TriangleMesh drawn(const Capsule& capsule) {
  const Vec3 along = capsule.b - capsule.a;
  const double length = along.norm();
  return placed(drape::capsule(around, capsule.radius, length),
                {length > 0 ? from_y_to(along) : Mat3::Identity(), (capsule.a + capsule.b) / 2});
}

}  // namespace

TriangleMesh drawn(const Shape& shape) {
  if (const auto* ball = std::get_if<Sphere>(&shape))
    return placed(sphere(fineness, ball->radius), {Mat3::Identity(), ball->centre});
  if (const auto* block = std::get_if<Box>(&shape))
    return placed(box(block->size), {block->rotation, block->centre});
  if (const auto* shell = std::get_if<Bowl>(&shape))
    return placed(bowl(around, shell->radius, shell->thickness), {from_y_to(shell->axis), shell->centre});
  if (const auto* rod = std::get_if<Capsule>(&shape)) return drawn(*rod);
  if (const auto* mesh = std::get_if<MeshBody>(&shape)) return (*mesh)->mesh();
  if (const auto* body = std::get_if<DeformingBody>(&shape)) return body->surface->mesh();
  return {};
}

TriangleMesh present_mesh(const MovingBody& body, double time) {
  TriangleMesh mesh = drawn(body.obstacle().shape);
  if (const auto* deforming = std::get_if<DeformingBody>(&body.obstacle().shape))
    deforming->frames->positions_at(time, mesh.positions);
  return placed(std::move(mesh), body.pose());
}

}  // namespace drape
