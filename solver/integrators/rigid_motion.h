// Where each piece of cloth, and each rope and soft body, comes to if it goes on as a rigid body. A piece
// is what forces other than those of contact join.
//   x* = p + h u + R (x - p),   R v = v + 2 / (1 + |t|^2) (t x v + t x (t x v)),   t = h w / 2
// p, u: the middle of what is held and the mean of the velocities that hold it; where nothing is held, the
// centre of mass and its velocity. R turns by 2 atan |t| about t. What is held says as much of w as it can:
// nothing where it is one particle, all but the turn about a line where it is a line. The free ones say the
// rest, by their angular momentum. So a sheet that hangs from two pins turns about the line between them, and
// one that is clamped stands.
//   A step of order 1 is linearised there. At the last state it would not know that what turns goes on along
// its tangents, and is longer then by half of the square of the angle. What pulls it back in the next step
// brakes the turn. A piece stays where it is instead where the rigid motion does not explain half of the
// energy that it has beside its centre of mass, as where a part of it has just been stopped.
// x [m], v [m/s], h [s], m [kg], w [rad/s].
#pragma once

#include <vector>

#include "solver/matrix/block_pattern.h"

namespace drape {

class RigidMotion {
 public:
  void follow(const BlockPattern& pattern);  // finds the pieces

  // x becomes x*. held: not 0 for particles that are held; those without mass are, too. v of what is held is
  // the velocity of what holds it. Allocates nothing.
  void go_on(const std::vector<double>& mass, const std::vector<char>& held, double h, const VecX& v,
             VecX& x);

 private:
  // Sums over some particles, of places and velocities from those of the pivot on.
  struct Sums {
    double weight = 0, energy = 0;  // energy: sum of w |v|^2
    Vec3 x = Vec3::Zero(), v = Vec3::Zero(), angular = Vec3::Zero();
    Mat3 spread = Mat3::Zero();  // sum of w x x^T
    void add(const Vec3& x, const Vec3& v, double by);
    Mat3 inertia() const { return spread.trace() * Mat3::Identity() - spread; }
  };
  struct Motion {
    Vec3 pivot = Vec3::Zero(), velocity = Vec3::Zero();
    Sums held, free;
    Vec3 t = Vec3::Zero();
    bool is_rigid = false;
    void find(double h);
  };
  template <class F>
  void each(const std::vector<double>& mass, const std::vector<char>& held, const F& f);

  std::vector<int> piece_;       // by particle
  std::vector<Motion> motions_;  // by piece
};

}  // namespace drape
