#include "mesh/distance/approach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/distance/closest_on_triangle.h"

namespace drape {
namespace {

// Where two edges roll on each other, a look proves no more of the way than takes their ends about as far as
// they are apart.
constexpr int most_looks = 1000;
constexpr double least_step = 1e-7;

// The places along the edges a b and c d, 0 to 1, of the points that are nearest to each other.
//   [Ericson 2005, Real-time collision detection, 5.1.9]
std::pair<double, double> closest_on_edges(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p = b - a, q = d - c, r = a - c;
  const double pp = p.squaredNorm(), qq = q.squaredNorm(), pq = p.dot(q), pr = p.dot(r), qr = q.dot(r);
  const auto place = [](double above, double below) {
    return below > 0 ? std::clamp(above / below, 0.0, 1.0) : 0.0;
  };
  // |p x q|^2: the difference of products would lose the digits of edges that are nearly parallel.
  double s = place(pq * qr - pr * qq, p.cross(q).squaredNorm());
  double t = place(pq * s + qr, qq);
  s = place(pq * t - pr, pp);
  t = place(pq * s + qr, qq);
  return {s, t};
}

// What must stay between the two sides on the way, and at its end [m].
struct Gaps {
  double on_the_way, at_end;
};

// `found` has the nearest() at s = 0 and the separation there.
Approach advance(bool edges, const FourPoints& start, const FourPoints& end, const Gaps& gaps,
                 Approach found) {
  double now = found.start;
  FourPoints here = start;
  for (int look = 0; look < most_looks && now > gaps.on_the_way; ++look) {
    const double last = separation(edges, end, found.last.normal);
    const bool clear = last > gaps.on_the_way;
    if (last > gaps.at_end || (clear && separation(edges, end, nearest(edges, end).normal) > gaps.at_end)) {
      found.until = 1;
      found.apart = true;
      return found;
    }
    const double from = clear ? gaps.at_end : gaps.on_the_way;
    const double step = now > from ? 0.99 * (now - from) / (now - last) * (1 - found.until) : 0;
    found.until += step;
    if (clear || step < least_step) break;
    for (std::size_t k = 0; k < 4; ++k) here[k] = start[k] + found.until * (end[k] - start[k]);
    found.last = nearest(edges, here);
    now = separation(edges, here, found.last.normal);
  }
  return found;
}

Approach begin(bool edges, const FourPoints& start) {
  const Nearest at_start = nearest(edges, start);
  return {.start = separation(edges, start, at_start.normal), .until = 0, .apart = false, .last = at_start};
}

// Whether this direction separates them by more than the gap all the way.
Approach along(bool edges, const FourPoints& start, const FourPoints& end, const Vec3& n, double gap) {
  Approach found{.until = 0, .apart = false};
  if (n.isZero(0)) return found;
  found.last.normal = n;
  found.start = separation(edges, start, n);
  if (!(found.start > gap) || !(separation(edges, end, n) > gap)) return found;
  found.until = 1;
  found.apart = true;
  return found;
}

}  // namespace

Nearest nearest(bool edges, const FourPoints& x) {
  Nearest found;
  if (edges) {
    const auto [s, t] = closest_on_edges(x[0], x[1], x[2], x[3]);
    found.weights = {1 - s, s, t - 1, -t};
  } else {
    const auto [point, feature] = closest_on_triangle(x[0], x[1], x[2], x[3]);
    const Vec3 w = weights_on_triangle(point, feature, x[1], x[2], x[3]);
    found.weights = {1, -w[0], -w[1], -w[2]};
  }
  Vec3 between = found.weights[0] * x[0];
  for (std::size_t k = 1; k < 4; ++k) between += found.weights[k] * x[k];
  found.distance = between.norm();
  found.normal = found.distance > 0 ? Vec3(between / found.distance) : Vec3(Vec3::Zero());
  return found;
}

double separation(bool edges, const FourPoints& x, const Vec3& n) {
  const std::array<double, 4> along = {n.dot(x[0]), n.dot(x[1]), n.dot(x[2]), n.dot(x[3])};
  double largest = 0;
  for (const Vec3& point : x) largest = std::max(largest, point.lpNorm<Eigen::Infinity>());
  const double rounding = 16 * std::numeric_limits<double>::epsilon() * n.lpNorm<1>() * largest;
  const double first = edges ? std::min(along[0], along[1]) : along[0];
  const double second = edges ? std::max(along[2], along[3]) : std::max({along[1], along[2], along[3]});
  return first - second - rounding;
}

Approach approach(bool edges, const FourPoints& start, const FourPoints& end, double gap,
                  const Vec3& likely) {
  if (const Approach found = along(edges, start, end, likely, gap); found.apart) return found;
  return advance(edges, start, end, {gap, gap}, begin(edges, start));
}

Approach approach_from_within(bool edges, const FourPoints& start, const FourPoints& end, double gap,
                              const Vec3& likely) {
  constexpr double touching = 1e-10;  // m
  constexpr double as_near = 1 - 1e-6;
  if (const Approach found = along(edges, start, end, likely, gap); found.apart) return found;
  Approach found = begin(edges, start);
  found.touching = found.last.distance < touching;
  if (found.touching || start == end) {
    found.until = 1;
    found.apart = true;
    return found;
  }
  // From near by only a way whose direction turns leads apart, and none keeps its distance at the start.
  constexpr double on_the_way = 0.5;
  const double at_end = std::min(gap, as_near * found.start);
  return advance(edges, start, end, {on_the_way * at_end, at_end}, found);
}

}  // namespace drape
