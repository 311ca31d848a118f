// The point of a triangle of cloth that is nearest to a body, or deepest in it, and the normal that leads the
// triangle straight out of the body there.
// Internal to the library's constraints.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "mesh/distance/closest_on_triangle.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/triangles/normals.h"

namespace drape::internal {

inline const Vec3 middle_weights = Vec3::Constant(1.0 / 3);

namespace search {

constexpr int most_steps = 24;
constexpr int most_met = most_steps + 1;  // where it begins, and where each step leads
constexpr double fine = 0.001;            // where it ends, as a share of the size of the triangle
constexpr double rough = 0.01;            // and where it ends on a triangle that is too far off to touch
constexpr double beside = 0.1;  // normals that are met within this share of it count as those of one place
// A mean of normals, or its part along the triangle, that is shorter than this tells no direction.
constexpr double level = 0.1;

}  // namespace search

struct FaceCorners {
  Vec3 a, b, c;
  FaceCorners(const std::array<int, 3>& particles, const VecX& x)
      : a(x.segment<3>(3 * particles[0])),
        b(x.segment<3>(3 * particles[1])),
        c(x.segment<3>(3 * particles[2])) {}
  Vec3 middle() const { return (a + b + c) / 3; }
  Vec3 at(const Vec3& weights) const { return weights[0] * a + weights[1] * b + weights[2] * c; }
  Vec3 normal() const { return twice_area_normal(a, b, c).stableNormalized(); }
  double radius() const {
    const Vec3 m = middle();
    return std::sqrt(std::max({(a - m).squaredNorm(), (b - m).squaredNorm(), (c - m).squaredNorm()}));
  }
};

struct Lowest {
  Vec3 point;
  Vec3 weights;
  SurfacePoint surface;  // its normal is the one that leads straight out of the triangle
};

// The normals that a search meets. Behind a rim or a corner of the body the lowest point is where two or
// three of the body's faces are equally near. The normal of none of them leads straight out of the triangle,
// but that of their means does which is the shortest along the triangle. Where it has a part along the
// triangle, that part leads along the rim to what is lower [Burke, Lewis & Overton 2005].
class MetNormals {
 public:
  explicit MetNormals(const Vec3& upright) : upright_(upright) {}
  // from: the normal where the search came from. What lies outside the body and faces the other way is
  // another part of its surface.
  void add(const Vec3& place, const SurfacePoint& met, const Vec3& from) {
    if (met.distance <= 0 || met.normal.dot(from) > -0.5)
      met_[static_cast<std::size_t>(count_++)] = {place, met.normal};
  }

  Vec3 along(const Vec3& n) const { return n - upright_.dot(n) * upright_; }
  // The mean that is shortest along the triangle, of `normal` and those of the `last` that were met within
  // this distance [m] of p. It is found by pairs, and nearly the shortest after two rounds.
  Vec3 straightest(const Vec3& p, Vec3 normal, double within, int last) const {
    const int begin = std::max(0, count_ - last);
    for (int round = 0; round < 2; ++round)
      for (const Met& met : std::span(met_).subspan(begin, count_ - begin))
        if ((met.place - p).squaredNorm() <= within * within) normal = between(normal, met.normal);
    return normal;
  }

 private:
  struct Met {
    Vec3 place, normal;
  };
  // The mean of a and b that is shortest along the triangle, or a where they nearly cancel each other, as in
  // the middle of a plate.
  Vec3 between(const Vec3& a, const Vec3& b) const {
    const Vec3 change = along(b - a);
    const double squares = change.squaredNorm();
    const double share = squares > 0 ? std::clamp(-a.dot(change) / squares, 0.0, 1.0) : 0.0;
    const Vec3 mean = a + share * (b - a);
    return mean.norm() < search::level ? a : Vec3(mean.normalized());
  }

  Vec3 upright_;
  std::array<Met, search::most_met> met_;
  int count_ = 0;
};

// Finds the point of the triangle that is nearest to the body. The search starts from the middle of the
// triangle or from the likely point, whichever is nearer. Its first step goes towards the closest point of
// the surface (alternating projections, which find a corner or a rim at once) [Cheney & Goldstein 1959]. The
// further steps go down the slope of the distance along the triangle, halved where they do not come nearer:
// on a surface as smooth as the cloth that lies on it, projections alone would creep.
template <class Distance>
Lowest lowest_point(const FaceCorners& t, const Distance& distance, double enough, const Vec3& likely) {
  Vec3 p = t.middle();
  SurfacePoint here = distance(p);
  Vec3 weights = middle_weights;
  const double size = t.radius();
  // All of the triangle is farther off than `enough`.
  if (const double least = here.distance - size; least > enough) return {p, weights, {least, here.normal}};
  if (likely != weights) {
    const Vec3 q = t.at(likely);
    if (const SurfacePoint there = distance(q); there.distance < here.distance) {
      p = q;
      here = there;
      weights = likely;
    }
  }
  MetNormals met(t.normal());
  met.add(p, here, here.normal);
  double step = size;
  for (int i = 0;
       i < search::most_steps && step > (here.distance > enough ? search::rough : search::fine) * size; ++i) {
    const Vec3 steepest = met.along(here.normal);
    // What was tried in vain last lies two steps away.
    const Vec3 mean = met.along(met.straightest(p, here.normal, 2.1 * step, 4));
    const Vec3& slope = mean.norm() > search::level ? mean : steepest;
    if (slope.norm() < search::fine) break;
    const bool first = i == 0 && here.distance > 0;
    const Vec3 wanted = p - (first ? Vec3(here.distance * here.normal) : Vec3(step * slope.normalized()));
    const auto [q, feature] = closest_on_triangle(wanted, t.a, t.b, t.c);
    if ((q - p).squaredNorm() < search::fine * search::fine * size * size) {
      if (first) continue;
      break;  // p is at the rim of the triangle, and the slope leads out of it
    }
    const SurfacePoint there = distance(q);
    met.add(q, there, here.normal);
    if (there.distance < here.distance - 1e-9) {
      weights = weights_on_triangle(q, feature, t.a, t.b, t.c);
      p = q;
      here = there;
    } else if (!first) {
      step /= 2;
    }
  }
  here.normal = met.straightest(p, here.normal, search::beside * size, search::most_met);
  return {p, weights, here};
}

}  // namespace drape::internal
