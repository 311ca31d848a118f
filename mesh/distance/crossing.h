// When a point on a straight way goes through a triangle whose corners go straight ways, too.
//   g(s) = (b - a) x (c - a) . (x - a),  a cubic of s: zero where the point lies in the triangle's plane
//                                        [Provot 1997, Collision and self-collision handling]
// Its roots are sought between its turning points, where it is monotone, so that none is passed over. What
// stays in the plane all the way (g = 0) does not cross. Internal to the library (not installed).
#pragma once

#include <array>

#include "mesh/base/vectors.h"

namespace drape::internal {

// From `from` at s = 0 to `to` at s = 1.
struct StraightWay {
  Vec3 from, to;
  Vec3 at(double s) const { return s == 1 ? to : Vec3(from + s * (to - from)); }
};

// The s in [0, 1], ascending, where c[0] + c[1] s + c[2] s^2 + c[3] s^3 is zero or, at a turning point, zero
// to rounding. Returns how many.
int roots_of_cubic(const std::array<double, 4>& c, std::array<double, 3>& roots);

// The s in [0, 1], ascending, at which x is in the plane of the triangle and inside it or within `tolerance`
// [m] of its sides. Returns how many.
int crossings(const StraightWay& x, const std::array<StraightWay, 3>& corners, double tolerance,
              std::array<double, 3>& found);

// How steeply x goes through the triangle at s, where it is at a point of it: the sine of the angle between
// its way, seen from that point, and the plane; negative against the triangle's normal. Not a number without
// an area or a way.
double steepness(const StraightWay& x, const std::array<StraightWay, 3>& corners, double s);

}  // namespace drape::internal
