// One particle touching bodies: which planes hold it, whether it sticks or slides, and with what impulse.
//   A plane is the body's surface, offset by the margin, linearised at the point nearest the particle's path:
//   gap = (x - point on the offset surface) . n, negative inside.
//
//   make     gap < 0, or the predicted path x -> x + h v meets the offset surface
//   target   gap >= 0: arrive exactly on the surface, v.n = v_b.n - gap / h
//            gap <  0: move with it, v.n = v_b.n, come out by y.n = min(-gap, recovery speed x h) [BW, 6]
//   release  the constraint would pull: r.n < 0
//   stick    |r_T| <= mu_s r.n: locked in all directions
//   slide    otherwise: locked along n, and rubbed by mu_k r.n against the sliding direction. The friction is
//            the damper c = mu_k (r.n / h) / |v_T|, taken implicitly: it can stop the motion and never turn
//            it round. In the step in which it comes loose, it is the impulse mu_k (r.n) r_T/|r_T|. Before
//            the first solve of a step r.n is that of the last step, its arrival impulse exchanged for the
//            one of now: else an impact would rub twice.
// r = A dv - b [N s]: the impulse of the constraint on the particle.
//                                           [Baraff & Witkin 1998 (BW), section 5.2; Noh & Jung, 4]
#pragma once

#include <algorithm>
#include <array>

#include "constraints/obstacle.h"

namespace drape {

struct ContactPlane {
  int obstacle;
  Vec3 normal;         // unit, out of the body
  double gap;          // m
  Vec3 body_velocity;  // m/s
};

enum class Grip { stick, breaking_loose, slide };

struct Contact {
  int particle;
  int planes = 0;                     // 1 to 3; 0: released in this step
  std::array<ContactPlane, 3> plane;  // deepest first
  Grip grip = Grip::stick;
  int changes = 0;                       // of the grip within this step
  double normal_impulse = 0;             // N s, the sum over the planes, of the last solve
  double arrival_impulse = 0;            // N s, of it: what takes away the approach to the planes that hold
  Vec3 friction_impulse = Vec3::Zero();  // N s, while breaking loose
  Vec3 slip = Vec3::Zero();  // m/s, tangential velocity against the body: expected at the end of this step
  Vec3 last_slip = Vec3::Zero();  // m/s, at the end of the step before

  bool active() const { return planes > 0; }
  // The directions the planes lock, orthonormal, one a column; the rest of the columns are zero.
  Mat3 locked_directions() const;
  Vec3 body_velocity() const { return plane[0].body_velocity; }
};

// How far off the margin what touched still does [m]: round-off and a small lift are not a release.
inline double touching_range(double margin) { return std::max(0.5 * margin, 1e-6); }

// Adds a plane unless it says nothing new; keeps the deepest first.
void add_plane(Contact& contact, const ContactPlane& plane);

// The vector with the given component along each plane's normal, and none across them.
Vec3 along_planes(const Contact& contact, const std::array<double, 3>& components);
// The multipliers of the planes: r = sum lambda_k n_k + a part tangential to all.
std::array<double, 3> multipliers(const Contact& contact, const Vec3& r);

}  // namespace drape
