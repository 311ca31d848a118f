// How far a motion goes, for `drape check`: sampled, from where it stands at the start.
//   way   max |x(t) - x(start)| of one point that is carried [m]
//   turn  max angle of R(t) R(start)^T, whole turns counted as a body makes them [rad]
#pragma once

#include <string>

#include "app/scene/scene.h"

namespace drape {

struct MotionExtent {
  double way = 0, turn = 0;
};

// X: the point, where it was drawn [m]. From start to end, which are finite [s].
MotionExtent motion_extent(const Motion& motion, const Vec3& X, double start, double end);

// "moved by keyframes, 0.4 to 1.56 s: by up to 0.3 m, turned by up to 90 deg". A motion without an end is
// followed to the end of the run [s].
std::string described(const Motion& motion, const MotionSource& source, const Vec3& X, double duration);

}  // namespace drape
