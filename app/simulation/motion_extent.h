// How far a motion goes from where it begins, for `drape check`. The motion is sampled.
//   way   max |x(t) - x(start)| of one point that is carried along [m]
//   turn  max angle of R(t) R(start)^T; whole turns add up [rad]
#pragma once

#include <string>

#include "app/scene/scene.h"

namespace drape::app {

struct MotionExtent {
  double way = 0, turn = 0;
};

// X is the point as it is drawn in the scene [m]. start and end are finite [s].
MotionExtent motion_extent(const Motion& motion, const Vec3& X, double start, double end);

// "moved by keyframes, 0.4 to 1.56 s: by up to 0.3 m, turned by up to 90 deg". A motion that never ends is
// followed for `duration` [s], to the end of the run.
std::string described(const Motion& motion, const MotionSource& source, const Vec3& X, double duration);

}  // namespace drape::app
