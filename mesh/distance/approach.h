// A vertex and a triangle, or two edges, whose corners go straight from one place to another while s goes
// from 0 to 1: how near they are, and how far on their ways they surely stay apart.
//   Two surfaces that are apart first meet in such a pair [Provot 1997].
// A direction n separates the corners of one side, A, from those of the other, B, by
//   f(s) = min over A of n . x(s)  -  max over B of n . x(s).
// For a fixed n this is a concave function of s. So where f is above a gap at both ends, it is above it all
// the way, and where it falls below the gap at the end, it stays above it at least until the chord does. From
// there the next n is taken: that of the points which are nearest to each other. Only sums and products, with
// a bound on their rounding: the answer errs on the safe side.
#pragma once

#include <array>

#include "mesh/base/vectors.h"

namespace drape {

// The vertex v[0] and the triangle v[1] v[2] v[3], or the edge v[0] v[1] and the edge v[2] v[3].
struct Encounter {
  std::array<int, 4> v;
  bool edges;

  bool operator==(const Encounter&) const = default;
  bool operator<(const Encounter& other) const {
    return edges != other.edges ? edges < other.edges : v < other.v;
  }
};

using FourPoints = std::array<Vec3, 4>;

// The points of the two sides that are nearest to each other: sum w_k x_k = distance * normal.
struct Nearest {
  std::array<double, 4> weights = {};  // those of the first side add up to 1, those of the second to -1
  Vec3 normal = Vec3::Zero();          // unit, from the second side to the first; zero when they touch
  double distance = 0;                 // m
};
Nearest nearest(bool edges, const FourPoints& x);

// How far apart the corners of the two sides are along n [m], less what rounding may change.
double separation(bool edges, const FourPoints& x, const Vec3& n);

struct Approach {
  double start = 0;       // their separation at s = 0 [m]
  double until = 1;       // they stay farther apart than the gap while s < until
  bool apart = true;      // whether they stay farther apart than the gap up to s = 1
  bool touching = false;  // whether they touched at the start, so that nothing was proven
  Nearest last = {};      // at the s at which was looked last
};
// gap [m] >= 0. When they are nearer than the gap at s = 0, until is 0. likely: a direction that may separate
// them, to be tried first.
Approach approach(bool edges, const FourPoints& start, const FourPoints& end, double gap,
                  const Vec3& likely = Vec3::Zero());
// The same for the end of the way; on the way half of the gap is enough. Where they start nearer than the
// gap, they need not go farther apart. Two sides that touch at the start count as apart.
Approach approach_from_within(bool edges, const FourPoints& start, const FourPoints& end, double gap,
                              const Vec3& likely = Vec3::Zero());

}  // namespace drape
