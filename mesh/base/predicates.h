// Tells on which side a point is, exactly: rounding cannot change the signs.
//   orient2d(a, b, c)     sign of  | bx-ax by-ay ; cx-ax cy-ay |          > 0: a, b, c counter-clockwise
//   orient3d(a, b, c, d)  sign of  (b - a) x (c - a) . (d - a)      > 0: d is where a, b, c are counter-clockwise
//   incircle(a, b, c, d)  sign of  | ax-dx ay-dy (ax-dx)^2+(ay-dy)^2 ; ... |   > 0: d inside the circle of
//                                                                              a, b, c (counter-clockwise)
// The sign comes from doubles where a bound on their error allows it [Shewchuk 1997, section 4, the first
// stage], and from whole numbers of any length where it does not. Coordinates must be finite.
#pragma once

#include "mesh/base/vectors.h"

namespace drape::internal {

int orient2d(const Vec2& a, const Vec2& b, const Vec2& c);
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int incircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

}  // namespace drape::internal
