// A rigid body that falls and that the cloth pushes: the other half of two-way contact.
//   m v' = m v + h m g + J,   L' = L + T,   c' = c + h u,   R' = exp(h [w]) R
// c is its centre of mass and v the velocity of that; L = R I R^T w is its angular momentum. J is minus the
// sum of the impulses r of the solve (and of friction) on the particles that touch it, and T their moment
// about c.
//
// Body and cloth are solved in turn: the cloth is solved with a prescribed motion q = (u, rho w) of the body
// (rho: its radius of gyration), and gives the impulse that makes q' = (v', rho w'). While the difference
// d = q' - q is not small the step is solved again with
//   q += sum c_i dq_i + a (d + sum c_i dd_i),   c = argmin |d + sum c_i dd_i|
// over the changes dq_i, dd_i between the solves of this step.
//                                                       [Degroote, Bathe & Vierendeels 2009, IQN-ILS]
// As long as the same contacts hold, d is linear in the six unknowns q, so that a few solves are enough. That
// is so even for a ball much lighter than the cloth that it meets, which the impulses alone (q <- q') would
// throw back and forth ever farther. a = 1/(1 + Z (1/m + T.I^-1 T / |J|^2)), where Z = |J| / the speed that J
// took away is the cloth's share of the inertia [kg]; later in the same contact, a is what the last step
// found. q starts from what the impulses of the last step would give, which is right at once for a body at
// rest. The body gets the impulses of the last solve, so that momentum is kept; only where d has not become
// small it gets the motion that was prescribed, and the step is not `converged`.
// w is that of the middle of the step, R_m^T L = I R_m^T w with R_m = exp(h [w] / 2) R, where nothing pushes:
// so a body that tumbles freely keeps its energy, too, and that inertia holds for the whole step. [Austin,
// Krishnaprasad & Wang 1993] What other bodies do to it changes q' too: the impulse P and its moment A about
// c are those of constraints/body_meeting.h, found for the motion that q' would be without them.
// m [kg], I [kg m^2] about c in the body's frame, c [m], v, u [m/s], w [rad/s], J [N s], T [N m s], h [s].
#pragma once

#include <optional>

#include "constraints/pose.h"

namespace drape {

struct RigidBody {
  double mass = 1;                  // kg
  Mat3 inertia = Mat3::Identity();  // about the centre of mass, in the body's frame [kg m^2]
  Vec3 centre = Vec3::Zero();       // of mass, in the body's frame [m]
  Vec3 velocity = Vec3::Zero();     // at the start [m/s]
  Vec3 spin = Vec3::Zero();         // at the start [rad/s]
  Vec3 gravity = {0, -9.81, 0};     // m/s^2
};

// Throws InputError when the mass is not positive or the inertia is not that of a body.
void check(const RigidBody& body);

class ReactingBody {
 public:
  static constexpr double well = 0.02;  // share of what the step changes within which it has converged

  ReactingBody(const RigidBody& body, const Pose& pose);

  // These hold at the end of the last completed step.
  const Pose& pose() const { return pose_; }
  const Vec3& velocity() const { return v_; }
  Vec3 spin() const;
  Vec3 momentum() const;
  Vec3 angular_momentum() const { return L_; }  // about its centre of mass
  Vec3 centre() const;
  // What cloth and other bodies gave it in that step [N s].
  const Vec3& impulse_of_cloth() const { return last_J_; }
  const Vec3& impulse_of_bodies() const { return last_P_; }

  double mass() const { return body_.mass; }
  // The velocity that an impulse gives the point `place` of the body: 1/m - [r] I^-1 [r], r from its centre
  // of mass
  // [m/s per N s].
  Mat3 mobility(const Vec3& place) const;

  Pose begin_step(double h);  // returns where the body is expected at the end of the step
  // Sum up the impulses of a solve on the body, from zero. approach: the speed that the impulse takes away
  // from a particle [m/s].
  void clear_impulse();
  void push(const Vec3& impulse, const Vec3& place, double approach = 0);
  // The same of what pulls without having run into the body, or reckons with how it gives way: the body may
  // become as fast as all of that together makes it.
  void pull(const Vec3& impulse, const Vec3& place, double approach);
  // Forgets the solves of this step so far, because what pushes next is another problem.
  void begin_corrections();
  // True when the impulses make another motion than the prescribed one; `end` is then the new pose.
  // noise [N s]: what in the impulses may be round-off.
  bool correct(Pose& end, double noise = 0);
  bool converged(double share = well) const;

  // What other bodies change of its motion in this step.
  Vec3 met_velocity() const;  // m/s
  Vec3 met_spin() const;      // rad/s
  // What other bodies do to it. The motion without that, by gravity and by the impulses of the cloth, of
  // which there are those of the last step before the first solve:
  Vec3 free_velocity() const;
  Vec3 free_spin() const;
  const Mat3& inverse_inertia() const { return inverse_inertia_; }  // in the middle of the step [1/(kg m^2)]
  const Vec3& gravity() const { return body_.gravity; }
  // Impulse P [N s] and moment A [N m s] of the other bodies in this step.
  void meet(const Vec3& impulse, const Vec3& moment);
  // Takes P and A into the prescribed motion before the first solve, and moves the body besides by u [m/s]
  // and w [rad/s] for the step, which its velocity does not keep. Returns the pose at the end of the step.
  Pose expect(const Vec3& u, const Vec3& w);
  bool end_step(const Pose& end);  // false: not converged

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  static constexpr int most_corrections = 12;  // in a step
  static constexpr int most_changes = 6;       // dq_i, dd_i that are remembered

  Pose moved() const;
  Vec6 difference() const;
  void stay_in_reach();
  double change() const;  // how much the step changes the velocity of the body [m/s]
  Mat3 world_inertia(const Mat3& rotation) const;
  Mat3 middle_inertia(double h) const;  // in the middle of the step, where nothing pushes

  RigidBody body_;
  double radius_;  // rho, the radius of gyration [m]
  Pose pose_;
  Vec3 v_, L_;
  Mat3 inverse_inertia_;
  double last_h_ = 0;                                   // length of the last completed step [s]
  Vec3 last_J_ = Vec3::Zero(), last_T_ = Vec3::Zero();  // impulse [N s] and its moment [N m s] in that step
  Vec3 last_P_ = Vec3::Zero();                          // impulse of other bodies [N s]

  // These belong to the step under way.
  double h_ = 0;
  Vec3 J_ = Vec3::Zero(), T_ = Vec3::Zero();
  Vec3 A_ = Vec3::Zero();                                   // moment of what other bodies do
  Vec6 met_ = Vec6::Zero(), y_ = Vec6::Zero();              // what they change of q', and of the pose alone
  double relaxation_ = 0;                                   // a above; 0: nothing touches the body
  Vec3 pulled_J_ = Vec3::Zero(), pulled_T_ = Vec3::Zero();  // the part of J_ and T_ that pulls
  double approach_ = 0;                                     // the largest approach of the last solve [m/s]
  double meeting_ = 0;  // the speed that the first solve that pushes may change [m/s]
  Vec6 q_ = Vec6::Zero(), q_free_ = Vec6::Zero();
  Vec6 last_q_ = Vec6::Zero(), last_d_ = Vec6::Zero();
  int corrections_ = 0, changes_ = 0;
  bool meets_ = false;  // another body
  bool known_ = false;  // last_q_ and last_d_ are those of a solve before
  Eigen::Matrix<double, 6, most_changes> dq_, dd_;
};

}  // namespace drape
