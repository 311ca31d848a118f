// Where each piece of cloth, and each rope and soft body, comes to if it goes on as a rigid body. A piece is what
// forces other than those of contact join.
//   x* = c + h u + R (x - c),   R v = v + 2 / (1 + |t|^2) (t x v + t x (t x v)),   t = h w / 2,   w = J^-1 L
// c, u: the centre of mass and its velocity; L, J: the angular momentum and the tensor of inertia about it, all with
// weights in place of the masses. R turns by 2 atan |t| about t. What is held counts a million times as much as
// what is free, so a piece goes on as what holds it lets it: a sheet that hangs from two pins turns about these,
// and one that is clamped stands.
//   A step of order 1 is linearised there. At the last state it would not know that what turns goes on along its
// tangents, and is longer then by half of the square of the angle. What pulls it back in the next step brakes
// the turn.
// x [m], v [m/s], h [s], m [kg], w [rad/s].
#pragma once

#include <vector>

#include "solver/matrix/block_pattern.h"

namespace drape {

class RigidMotion {
 public:
  void follow(const BlockPattern& pattern);  // finds the pieces

  // x becomes x*. held: not 0 for particles that are held; those without mass are, too. Allocates nothing.
  void go_on(const std::vector<double>& mass, const std::vector<char>& held, double h, const VecX& v,
             VecX& x);

 private:
  struct Motion {
    double weight = 0;
    Vec3 origin = Vec3::Zero();  // a place in the piece, from which all but `way` is counted
    Vec3 middle = Vec3::Zero(), momentum = Vec3::Zero(), angular = Vec3::Zero();
    Mat3 spread = Mat3::Zero();  // sum of w r r^T
    Vec3 way = Vec3::Zero(), t = Vec3::Zero();
    void add(const Vec3& x, const Vec3& v, double by);
    void find(double h);
  };

  std::vector<int> piece_;       // by particle
  std::vector<int> first_;       // by piece: one of its particles
  std::vector<Motion> motions_;  // by piece
};

}  // namespace drape
