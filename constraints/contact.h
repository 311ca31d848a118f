// One particle touching bodies: which planes hold it, whether it sticks or slides, and with what impulse.
//   A plane is the body's surface, offset by the margin, linearised at the point nearest the particle's path:
//   gap = (x - point on the offset surface) . n, negative inside.
//
//   make     a contact begins where gap < 0, or where the predicted path x -> x + h v meets the offset
//            surface
//   target   gap >= 0: the particle arrives exactly on the surface, v.n = v_b.n - gap / h
//            gap <  0: it moves with the body, v.n = v_b.n, and comes out by y.n = min(-gap, recovery speed
//            x h) [BW98, 6]
//   release  a contact ends where the constraint would pull: r.n < 0
//   stick    where |r_T| <= mu_s r.n: the particle is locked in all directions
//   slide    otherwise: the particle is locked along n, and mu_k r.n rubs against the sliding direction. The
//            friction is the damper c = mu_k (r.n / h) / |v_T|, taken implicitly: it can stop the motion and
//            never turn it round. In the step in which the particle comes loose, friction is the impulse
//            mu_k (r.n) r_T/|r_T|. Before the first solve of a step r.n is taken from the last step, with its
//            arrival impulse replaced by that of this step: otherwise an impact would rub twice.
//   stop     where friction can stop all that slides on a body within a step, and it slows down, the step
//            begins with it as sticking; where |r_T| > mu_k r.n it slides on, rubbed as above
// r = A dv - b [N s] is the impulse of the constraint on the particle.
//                                           [Baraff & Witkin 1998 (BW98), section 5.2; Noh & Jung, section 4]
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
  int planes = 0;                     // 1 to 3; 0: the contact was released in this step
  std::array<ContactPlane, 3> plane;  // the deepest first
  Grip grip = Grip::stick;
  int changes = 0;                       // how often the grip has changed within this step
  double normal_impulse = 0;             // sum over the planes [N s], of the last solve
  double arrival_impulse = 0;            // the part that stops the approach to the planes that hold [N s]
  Vec3 friction_impulse = Vec3::Zero();  // impulse of friction while breaking loose [N s]
  Vec3 slip = Vec3::Zero();  // tangential velocity against the body, expected at the end of this step [m/s]
  Vec3 last_slip = Vec3::Zero();  // the same at the end of the step before [m/s]

  bool active() const { return planes > 0; }
  // The directions that the planes lock: orthonormal, one in a column; the remaining columns are zero.
  Mat3 locked_directions() const;
  Vec3 body_velocity() const { return plane[0].body_velocity; }
};

// How far off the margin a particle that touched in the last step is still taken to touch [m]: round-off and
// a small lift do not release it.
inline double touching_range(double margin) { return std::max(0.5 * margin, 1e-6); }

// Adds a plane unless the planes that are there imply it already; keeps the deepest first.
void add_plane(Contact& contact, const ContactPlane& plane);

// The vector in the span of the normals that has the given component along each plane's normal.
Vec3 along_planes(const Contact& contact, const std::array<double, 3>& components);
// The multipliers lambda_k of the planes: r = sum lambda_k n_k + a part that is tangential to all planes.
std::array<double, 3> multipliers(const Contact& contact, const Vec3& r);

}  // namespace drape
