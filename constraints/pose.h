#pragma once
#include "mesh/triangle_mesh.h"
namespace drape {
struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();
  Vec3 to_world(const Vec3& X) const { return rotation * X + translation; }
  Vec3 to_body(const Vec3& x) const { return rotation.transpose() * (x - translation); }
};
}  // namespace drape
