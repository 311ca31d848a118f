// The first meeting of a straight path with a shape.
//   f(s) = phi(x(s)) - margin,  f'(s) = n . direction,  s [m]: the length gone along the path
// For convex shapes f is convex: Newton's step from the left never passes the first root, and a path on which
// f rises stays clear.
//
// For other shapes f cannot fall faster than 1, so that a step of |f| is safe [Hart 1996, sphere tracing].
// Where |f| is below a resolution r, Newton's step is taken, at most r long; if f rises after it, the lowest
// f in between is sought. A path that slides along a surface costs about length / r evaluations of the
// distance. The search can miss only what is thinner than r - 2 margin and hidden from the path by a nearer
// surface. r = 1 mm for paths up to 256 mm, and a 256th of the length for longer ones.
//
// Against a surface that deforms, s [m] counts the most by which path and surface can approach each other,
//   length = |x1 - x0 - m| + max_i |u_i - m|,  u_i: the displacements of the vertices, m: their mean,
// so that f still falls no faster than 1; f' = n . (x1 - x0 - u) / length, u being the displacement of the
// closest point. What could slip through where the margin is below r / 2 is found as a root of the triangles'
// cubics (mesh/distance/crossing.h).
#include <algorithm>
#include <cmath>

#include "constraints/shape.h"

namespace drape {
namespace {

constexpr double touch = 1e-8;       // f below this is a meeting [m]
constexpr double sliding = 1e-9;     // a slope below this counts as none
constexpr double resolution = 1e-3;  // m
constexpr double rounding = 1e-12;   // a particle that goes with a moving surface strays no farther [m]
constexpr int resolved_steps = 256;  // steps of length r in a long path
constexpr int most_steps = 2 * resolved_steps;
constexpr int most_halvings = 40;

// f and f' at one place of the path.
struct Station {
  double s = 0, f = 0, slope = 0;
  SurfacePoint surface{};
};

// direction: the way of the particle for a metre of s; a unit vector where the surface does not deform.
struct Path {
  const Shape& shape;
  Vec3 start, direction;
  double length, margin;

  Station at(double s) const {
    const Vec3 x = start + s * direction;
    if (const DeformingBody* const body = deforming(shape)) {
      Vec3 displacement;
      const SurfacePoint surface = body->surface->closest(x, s / length, displacement);
      return {s, surface.distance - margin, surface.normal.dot(direction - displacement / length), surface};
    }
    Station here{s, 0, 0, closest(shape, x)};
    here.f = here.surface.distance - margin;
    here.slope = here.surface.normal.dot(direction);
    return here;
  }
  Hit hit(const Station& here) const { return {length > 0 ? here.s / length : 0.0, here.surface}; }
};

bool nearer_still(const Station& here) { return here.f <= touch && here.slope < -sliding; }

// Finds where f first falls to `touch`, to rounding, between `clear` (f > touch) and `met` (f <= touch).
Station meeting(const Path& path, Station clear, Station met) {
  for (int i = 0; i < most_halvings && met.f < -touch && met.s - clear.s > touch; ++i) {
    const double safe = clear.s + clear.f;
    const Station middle = path.at(std::max(safe, 0.5 * (clear.s + met.s)));
    (middle.f > touch ? clear : met) = middle;
  }
  return met;
}

// f rises at `right`, and both ends are clear: did f fall to `touch` in between? The part in which the slope
// turns is halved until the Lipschitz bound shows that it is clear.
std::optional<Station> dip(const Path& path, Station left, Station right) {
  for (int i = 0; i < most_halvings && left.f + right.f < right.s - left.s; ++i) {
    const Station middle = path.at(0.5 * (left.s + right.s));
    if (middle.f <= touch) return meeting(path, left, middle);
    (middle.slope < 0 ? left : right) = middle;
  }
  return std::nullopt;
}

std::optional<Hit> first_hit_convex(const Path& path) {
  Station here = path.at(0);
  for (int i = 0; i < most_steps; ++i) {
    if (here.slope >= -sliding) return std::nullopt;  // a convex f does not fall again
    if (here.f <= touch) return path.hit(here);
    const double s = here.s + here.f / -here.slope;
    if (s > path.length) return std::nullopt;
    here = path.at(s);
    if (here.f <= touch) return path.hit(here);
  }
  return path.hit(here);
}

double resolution_of(const Path& path) { return std::max(resolution, path.length / resolved_steps); }

std::optional<Hit> first_hit_any(const Path& path) {
  const double r = resolution_of(path);
  Station here = path.at(0);
  if (nearer_still(here)) return path.hit(here);
  bool leaving = here.f <= touch;  // the path starts within the margin and is not yet out of it
  for (int i = 0; i < most_steps && here.s < path.length; ++i) {
    const double newton = here.slope < -sliding ? std::min(here.f / -here.slope, r) : r;
    const double step = std::max(std::abs(here.f), newton);
    const Station there = path.at(std::min(here.s + step, path.length));
    if (leaving) {
      if (nearer_still(there)) return path.hit(there);
      leaving = there.f <= touch;
    } else if (there.f <= touch) {
      return path.hit(meeting(path, here, there));
    } else if (there.slope > sliding) {
      if (const auto found = dip(path, here, there)) return path.hit(*found);
    }
    here = there;
  }
  if (here.s < path.length && here.f < r)
    return path.hit(here);  // the path is too long to follow: it stops where it is near the surface
  return std::nullopt;
}

// First the advancement along the distance; then what that may not see: a surface that the path goes through
// within r, and one that is met by a path that starts within the margin and leaves.
std::optional<Hit> first_hit_deforming(const SurfaceDistance& surface, const Path& path) {
  const Station start = path.at(0);
  if (start.f > touch &&
      surface.stays_clear(path.start, path.start + path.length * path.direction, path.margin + touch))
    return std::nullopt;
  const std::optional<Hit> hit = first_hit_any(path);
  const bool leaves = start.f <= touch;
  const bool seen = 2 * path.margin >= resolution_of(path) && !leaves;
  const bool too_far = std::abs(start.surface.distance) > path.length;
  if (seen || too_far || (hit && hit->fraction == 0)) return hit;
  const bool on_it = !surface.closed() && start.surface.distance <= touch;  // and not yet through it
  const double from = on_it ? 2 * touch / path.length : 0;
  const auto s = surface.first_crossing(path.start, path.start + path.length * path.direction, from);
  if (!s || (hit && hit->fraction <= *s)) return hit;
  return path.hit(path.at(std::max(0.0, *s * path.length - touch)));  // on the side that the path comes from
}

}  // namespace

std::optional<Hit> first_hit(const Shape& shape, const Vec3& x0, const Vec3& x1, double margin) {
  const Vec3 way = x1 - x0;
  if (const DeformingBody* const body = deforming(shape)) {
    const SurfaceMotion& motion = body->surface->motion();
    const double most = (way - motion.mean).norm() + motion.about_mean;
    if (!(most > rounding)) return std::nullopt;
    return first_hit_deforming(*body->surface, {shape, x0, way / most, most, margin});
  }
  const double length = way.norm();
  if (!(length > 0)) return std::nullopt;
  const Path path{shape, x0, way / length, length, margin};
  return convex(shape) ? first_hit_convex(path) : first_hit_any(path);
}

}  // namespace drape
