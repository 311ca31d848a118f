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

  Vec3 to_world(const Vec3& X) const;
  Vec3 to_body(const Vec3& x) const;
  Vec3 direction_to_world(const Vec3& D) const;
  Vec3 direction_to_body(const Vec3& d) const;
};

// Applies the right one first: (a * b).to_world(X) = a.to_world(b.to_world(X)).
Pose operator*(const Pose& a, const Pose& b);

Pose inverse(const Pose& pose);

}  // namespace drape
