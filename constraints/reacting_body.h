// A rigid body that falls, and that the cloth pushes: the other half of two-way contact.
//   m v' = m v + h m g + J,   L' = L + T,   c' = c + h u,   R' = exp(h [w]) R
// c, v: its centre of mass and that one's velocity; L = R I R^T w: its spin. J, T: minus the impulses r of
// the solve (and of friction) on the particles that touch it, and their moment about c.
//
// Staggered: the cloth is solved with a prescribed motion q = (u, rho w) of the body (rho: its radius of
// gyration), and gives the impulse that makes q' = (v', rho w'). While the difference d = q' - q is not small
// the step is solved again with
//   q += sum c_i dq_i + a (d + sum c_i dd_i),   c = argmin |d + sum c_i dd_i|
// over the changes dq_i, dd_i between the solves of this step.       [Degroote, Bathe & Vierendeels 2009,
// IQN-ILS] As long as the same contacts hold, d is linear in q, of six unknowns: a few solves do, also for a
// ball much lighter than the cloth that it meets, which the impulses alone (q <- q') would throw back and
// forth, ever farther. a = 1/(1 + Z/m), Z = |J| / the speed that J took away: the cloth's share of the
// inertia; later in the same contact it is what the last step found. At the start q is what the last step's
// impulses would give: at rest that is right at once. The body gets the impulses of the last solve, so
// momentum is kept; only where d is not small to the end it gets the motion that was prescribed, and the step
// is not `converged`. Contact between such bodies, and of them with obstacles, is not looked for.
// m [kg], I [kg m^2] about c in the body's frame, c [m], v, u [m/s], w [rad/s], J [N s], T [N m s], h [s].
#pragma once

#include <optional>

#include "constraints/pose.h"

namespace drape {

struct RigidBody {
  double mass = 1;                  // kg
  Mat3 inertia = Mat3::Identity();  // kg m^2, about the centre of mass, in the body's frame
  Vec3 centre = Vec3::Zero();       // m, of mass, in the body's frame
  Vec3 velocity = Vec3::Zero();     // m/s, at the start
  Vec3 spin = Vec3::Zero();         // rad/s, at the start
  Vec3 gravity = {0, -9.81, 0};     // m/s^2
};

// Throws InputError when the mass is not positive or the inertia is not that of a body.
void check(const RigidBody& body);

class ReactingBody {
 public:
  static constexpr double well = 0.02;  // of what the step changes: converged

  ReactingBody(const RigidBody& body, const Pose& pose);

  // Of the last completed step.
  const Pose& pose() const { return pose_; }
  const Vec3& velocity() const { return v_; }
  Vec3 spin() const;
  Vec3 momentum() const { return body_.mass * v_; }
  Vec3 angular_momentum() const { return L_; }  // about its centre of mass
  Vec3 centre() const { return pose_.to_world(body_.centre); }

  Pose begin_step(double h);  // where it is expected at the end
  // What a solve pushes it with, from zero. approach: the speed that the impulse takes away from a particle.
  void clear_impulse();
  void push(const Vec3& impulse, const Vec3& place, double approach = 0);
  // True when the motion that was prescribed is not the one that the impulse makes: then `end` is the new
  // one. noise [N s]: of the impulses.
  bool correct(Pose& end, double noise = 0);
  bool converged(double share = well) const;
  bool end_step(const Pose& end);  // false: not converged

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  static constexpr int most_corrections = 12;  // in a step
  static constexpr int most_changes = 6;       // that are remembered

  Pose moved() const;
  Vec6 difference() const;
  void stay_in_reach();
  double change() const;  // m/s, what the step does to it
  Mat3 world_inertia(const Pose& pose) const;

  RigidBody body_;
  double radius_;  // m, of gyration
  Pose pose_;
  Vec3 v_, L_;
  double last_h_ = 0;                                   // s, of the last completed step
  Vec3 last_J_ = Vec3::Zero(), last_T_ = Vec3::Zero();  // N s, N m s, then

  // Of the step under way.
  double h_ = 0;
  Vec3 J_ = Vec3::Zero(), T_ = Vec3::Zero();
  double relaxation_ = 0;  // a; 0: nothing touches it
  double approach_ = 0;    // m/s
  double meeting_ = 0;     // m/s, the approach at the start of the step
  Vec6 q_ = Vec6::Zero(), q_free_ = Vec6::Zero();
  bool known_ = false;  // q and d of a solve before
  Vec6 last_q_ = Vec6::Zero(), last_d_ = Vec6::Zero();
  int corrections_ = 0, changes_ = 0;
  Eigen::Matrix<double, 6, most_changes> dq_, dd_;
};

}  // namespace drape
