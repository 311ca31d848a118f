// A rigid body that falls, and that the cloth pushes: the other half of two-way contact.
//   m v' = m v + h m g + J,   L' = L + T,   c' = c + h u,   R' = exp(h [w]) R
// c, v: its centre of mass and that one's velocity; L = R I R^T w: its spin. J, T: minus the impulses r of
// the solve (and of friction) on the particles that touch it, and their moment about c.
//
// Staggered: the cloth is solved with a prescribed motion u, w of the body, and gives the impulse that makes
// v', w'. While these differ, the step is solved again with
//   (u, w) += a [(v', w') - (u, w)],   a <- a d_old . (d_old - d) / |d_old - d|^2
// (d: the difference in brackets). Without a (a = 1) a ball lighter than the cloth it meets is thrown back
// and forth, ever farther.                                    [Aitken's relaxation: Kuettler & Wall 2008, eq.
// 44] At the start (u, w) is what the last step's impulses would give: at rest that is right at once. J and T
// of the last solve are what the body gets, so momentum is conserved whether this has converged or not.
// Contact between such bodies, and of them with obstacles, is not looked for.
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
  ReactingBody(const RigidBody& body, const Pose& pose);

  // Of the last completed step.
  const Pose& pose() const { return pose_; }
  const Vec3& velocity() const { return v_; }
  Vec3 spin() const;
  Vec3 momentum() const { return body_.mass * v_; }
  Vec3 angular_momentum() const { return L_; }  // about its centre of mass
  Vec3 centre() const { return pose_.to_world(body_.centre); }

  Pose begin_step(double h);  // where it is expected at the end
  void clear_impulse() { J_.setZero(), T_.setZero(); }
  void push(const Vec3& impulse, const Vec3& place);
  // True when the motion that was prescribed is not the one that the impulse makes: then `end` is the new
  // one.
  bool correct(Pose& end);
  void end_step(const Pose& end);

 private:
  Pose moved() const;
  Eigen::Matrix<double, 6, 1> difference() const;
  Mat3 world_inertia(const Pose& pose) const;

  RigidBody body_;
  double radius_;  // m, of gyration: makes a speed of a spin
  Pose pose_;
  Vec3 v_, L_;
  Vec3 J_ = Vec3::Zero(), T_ = Vec3::Zero();

  // Of the step under way.
  double h_ = 0, relaxation_ = 1;
  int corrections_ = 0;
  Vec3 u_ = Vec3::Zero(), w_ = Vec3::Zero();
  Eigen::Matrix<double, 6, 1> last_difference_ = Eigen::Matrix<double, 6, 1>::Zero();
};

}  // namespace drape
