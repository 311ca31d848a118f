// One particle touching bodies: which planes hold it, whether it sticks or slides, and with what impulse.
//   A plane is the body's surface, offset by the margin, linearised at the point nearest the particle's path:
//   gap = (x - point on the offset surface) . n, negative inside.
//
//   make     a contact begins where gap < 0, but for rounding, or where the predicted path x -> x + h v meets the
//            offset surface
//   target   gap >= 0: the particle arrives exactly on the surface, v.n = v_b.n - gap / h
//            gap <  0: it moves with the body, v.n = v_b.n, and comes out by y.n = min(-gap, recovery speed
//            x h) [BW98, 6]
//   release  a contact ends where the constraint would pull: r.n < 0
//   catch    a plane that was let go holds again where the motion would pass through it, and a particle that
//            would pass through a body is held by it. The first begins to slide, without friction in the first
//            solve: if it stuck, it might be let go again. The second begins as if its particle were alone.
//   stick    where |r_T| <= mu_s r.n: the particle is locked in all directions
//   slide    otherwise: the particle is locked along n, and mu_k r.n rubs against the slip s, its velocity along
//            the surface as seen by the body. This is Coulomb's law, linearised at the slip s_0 of the solve
//            before, t = s_0 / |s_0|: an impulse against t, and a damper across it,
//                p = -mu_k (r.n) (t + (I - t t^T) s / |s_0|)
//            After the solve it is linearised anew at p - w s, which would stop a particle that meets the
//            inertia w: where that is at most mu_k r.n the particle sticks, otherwise s_0 points against it and
//            |s_0| = (|p - w s| - mu_k r.n) / w.            [Hueber, Stadler & Wohlmuth 2008, section 3]
//   brake    before the first solve of a step s_0 is not known, so friction is the damper mu_k (r.n) / |s_e| in all
//            directions, with the slip s_e that is expected: it cannot turn the motion round. r.n is taken from
//            the last step, with its arrival impulse replaced by that of this step: otherwise an impact would
//            rub twice. A contact that has come loose too often ends as one that is braked. What begins to touch, and
//            slips, is braked, too; so is what slid when the impulse turned its slip round, with a quarter of the slip.
//   doubt    where a contact changed more than once, was let go and held again, or went up and down, r.n changes by a half
//            to all of what a solve asks for, as the last two solves tell: friction may lift a particle off, or press it on,
//            by more than it takes itself
//   clamp    where a body overlaps itself, as thighs do that are pressed into each other, or where two bodies
//            or the sides of a fold of one close on the cloth (nips.cpp), there is no way out that the cloth
//            could take: the particle goes with the body, or with both sides, in all directions, whatever
//            pulls, until it is free
//   stop     where friction can stop all that slides on a body within a step, and it slows down, the step
//            begins with it as sticking
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

enum class Grip { stick, slide, brake };  // what is braked slides, too

struct Contact {
  int particle;
  int planes = 0;  // that hold the particle: 1 to 3; 0: it was let go in this step
  // Those that hold it, and behind them those that may: they were let go in this step, or are the other side
  // of a fold.
  int known = 0;
  std::array<ContactPlane, 3> plane;  // of those that hold, the deepest first
  Grip grip = Grip::stick;
  bool clamped = false;       // it sticks whatever pulls
  int leader = -1;            // the body with which it goes then along both surfaces; -1: the mean of both
  bool comes_out = false;     // it began inside the body, and is being brought out
  int changes = 0;            // how often the grip has changed within this step
  int catches = 0;            // how often a plane that was let go in this step has held it again
  double normal_impulse = 0;  // sum over the planes [N s], of the last solve
  // Of each plane that holds, at the end of a step [N s]; 0 of what is clamped.
  std::array<double, 3> impulse = {};
  int turns = 0;               // how often it has gone up after down, or down after up, within this step
  double last_change = 0;      // by how much the last solve asked for another one [N s]
  double relaxed = 1;          // by which share of that it followed
  double arrival_impulse = 0;  // the part that stops the approach to the planes that hold [N s]
  Vec3 friction_impulse = Vec3::Zero();  // -mu_k (r.n) t of what slides [N s]
  Vec3 slip = Vec3::Zero();              // s_0 of what slides, s_e of what is braked [m/s]
  Vec3 last_slip = Vec3::Zero();         // the same at the end of the step before [m/s]

  bool active() const { return planes > 0; }
  // The directions that the planes lock: orthonormal, one in a column; the remaining columns are zero.
  Mat3 locked_directions() const;
  Vec3 body_velocity() const { return plane[0].body_velocity; }
};

// How far off the margin a particle that touched in the last step is still taken to touch [m]: round-off and
// a small lift do not release it.
inline double touching_range(double margin) { return std::max(0.5 * margin, 1e-6); }

// Lets the plane with this number go, and remembers it behind those that hold.
void let_go(Contact& contact, int plane);
// Adds a plane to those that hold, the deepest first, unless they imply it already: then it returns false.
bool add_plane(Contact& contact, const ContactPlane& plane);
// The same; but of two planes that are nearly one, the deeper holds.
void add_deepest(Contact& contact, const ContactPlane& plane);
// The same; but where they imply it in direction and not in place, it takes the place of the one whose multiplier is
// zero first as the new plane pushes. r is their reaction.            [Goldfarb & Idnani 1983, step 2]
bool add_or_exchange(Contact& contact, const Vec3& r, const ContactPlane& plane);
// Lets a plane that was let go hold again, in the same way.
bool hold_again(Contact& contact, const Vec3& r, int plane);

// The vector in the span of the normals that has the given component along each plane's normal.
Vec3 along_planes(const Contact& contact, const std::array<double, 3>& components);
// The multipliers lambda_k of the planes: r = sum lambda_k n_k + a part that is tangential to all planes.
std::array<double, 3> multipliers(const Contact& contact, const Vec3& r);

}  // namespace drape
