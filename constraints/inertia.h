// The inertia that friction is looked for with, of vertices (constraints/grip.cpp) and of faces
// (constraints/face_contact.cpp).
// Internal to the library's constraints.
#pragma once

#include <algorithm>

#include "constraints/step_motion.h"

namespace drape::internal {

// A push of a particle meets its mass and, through what joins them, some of its neighbours. It is taken to
// meet this share of the inertia that it meets while they stay behind. (On a ball, a sheet of 10 k vertices
// took 3.0 solves a step and 141 iterations with springs, 3.2 and 112 woven. With a share of 0.25 it took 4.1
// and 193, and 3.0 and 114; with 0.06 it took 3.6 and 162, and 3.5 and 114.)
inline constexpr double share_of_inertia = 0.12;

inline double inertia_met(const StepMotion& step, int particle) {  // kg
  return std::max(step.mass(particle), share_of_inertia * step.inertia[static_cast<std::size_t>(particle)]);
}

}  // namespace drape::internal
