// Finds when a point on a straight way goes through a triangle whose corners also go straight ways.
//   g(s) = (b - a) x (c - a) . (x - a),  a cubic of s: zero where the point lies in the triangle's plane
//                                        [Provot 1997, Collision and self-collision handling]
// The roots of g are sought between its turning points, where it is monotone, so that no root is passed over.
// A point that stays in the plane all the way (g = 0) does not cross it.
#pragma once

#include <array>

#include "mesh/base/vectors.h"

namespace drape::internal {

// A way that leads straight from `from` at s = 0 to `to` at s = 1.
struct StraightWay {
  Vec3 from, to;
  Vec3 at(double s) const { return s == 1 ? to : Vec3(from + s * (to - from)); }
};

// Finds the s in [0, 1], ascending, where c[0] + c[1] s + c[2] s^2 + c[3] s^3 is zero or, at a turning point,
// zero up to rounding. Returns the number of roots.
int roots_of_cubic(const std::array<double, 4>& c, std::array<double, 3>& roots);

// Finds the s in [0, 1], ascending, at which x is in the plane of the triangle and either inside the triangle
// or within `tolerance` [m] of its sides. Returns the number of crossings.
int crossings(const StraightWay& x, const std::array<StraightWay, 3>& corners, double tolerance,
              std::array<double, 3>& found);

// How steeply x goes through the triangle at an s where x is at a point of it: the sine of the angle between
// the plane and the way of x as seen from that point. The sine is negative when x goes against the triangle's
// normal, and not a number when the triangle has no area or x does not move.
double steepness(const StraightWay& x, const std::array<StraightWay, 3>& corners, double s);

}  // namespace drape::internal
