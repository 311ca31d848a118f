// Where a rigid body is.
//   x = R X + t,  X: a point of the body where it was drawn, x: the same point where it is at the time   [m]
//   R rotation (orthonormal, right-handed), t translation [m]
// The default, R = 1 and t = 0, leaves everything where it was drawn.
#pragma once

#include "mesh/base/vectors.h"

namespace drape {

struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();  // m

  Vec3 to_world(const Vec3& X) const { return rotation * X + translation; }
  Vec3 to_body(const Vec3& x) const { return rotation.transpose() * (x - translation); }
  Vec3 direction_to_world(const Vec3& D) const { return rotation * D; }
  Vec3 direction_to_body(const Vec3& d) const { return rotation.transpose() * d; }
};

// Applies the right one first: (a * b).to_world(X) = a.to_world(b.to_world(X)).
inline Pose operator*(const Pose& a, const Pose& b) {
  return {a.rotation * b.rotation, a.to_world(b.translation)};
}

inline Pose inverse(const Pose& pose) { return {pose.rotation.transpose(), pose.to_body(Vec3::Zero())}; }

}  // namespace drape
