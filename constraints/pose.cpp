#include "constraints/pose.h"

namespace drape {

Vec3 Pose::to_world(const Vec3& X) const { return rotation * X + translation; }
Vec3 Pose::to_body(const Vec3& x) const { return rotation.transpose() * (x - translation); }
Vec3 Pose::direction_to_world(const Vec3& D) const { return rotation * D; }
Vec3 Pose::direction_to_body(const Vec3& d) const { return rotation.transpose() * d; }

Pose operator*(const Pose& a, const Pose& b) { return {a.rotation * b.rotation, a.to_world(b.translation)}; }

Pose inverse(const Pose& pose) { return {pose.rotation.transpose(), pose.to_body(Vec3::Zero())}; }

}  // namespace drape
