#include "mesh/distance/crossing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/distance/closest_on_triangle.h"
#include "mesh/triangles/normals.h"

namespace drape::internal {
namespace {

double value(const std::array<double, 4>& c, double s) { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }

// The root between lo and hi, where the cubic is monotone and changes its sign, found by bisection to the
// last digit.
double bisect(const std::array<double, 4>& c, double lo, double hi) {
  const bool rises = value(c, lo) < 0;
  while (true) {
    const double middle = 0.5 * (lo + hi);
    if (middle <= lo || middle >= hi) return middle;
    ((value(c, middle) < 0) == rises ? lo : hi) = middle;
  }
}

// The turning points of the cubic within (0, 1), ascending.
int turning_points(const std::array<double, 4>& c, std::array<double, 2>& found) {
  const double a = 3 * c[3], half_b = c[2], d = c[1];  // a s^2 + 2 half_b s + d = 0
  const double discriminant = half_b * half_b - a * d;
  if (!(discriminant >= 0)) return 0;
  const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));  // no difference of equals
  int count = 0;
  for (const auto& [over, under] : {std::pair(q, a), std::pair(d, q)}) {
    const double s = over / under;
    if (s > 0 && s < 1) found[count++] = s;
  }
  if (count == 2 && found[1] < found[0]) std::swap(found[0], found[1]);
  return count;
}

}  // namespace

int roots_of_cubic(const std::array<double, 4>& c, std::array<double, 3>& roots) {
  const double rounding = 4e-15 * (std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]) + std::abs(c[3]));
  std::array<double, 2> turns{};
  const int turn_count = turning_points(c, turns);
  int count = 0;
  double lo = 0;
  for (int piece = 0; piece <= turn_count; ++piece) {
    const double hi = piece < turn_count ? turns[piece] : 1;
    const double at_lo = value(c, lo), at_hi = value(c, hi);
    const auto add = [&](double s) {
      if (count < 3 && (count == 0 || s > roots[count - 1])) roots[count++] = s;
    };
    if (at_lo == 0) add(lo);
    if ((at_lo < 0 && at_hi > 0) || (at_lo > 0 && at_hi < 0))
      add(bisect(c, lo, hi));
    else if (at_hi == 0 || (piece < turn_count && std::abs(at_hi) <= rounding))
      add(hi);  // it touches zero and turns
    lo = hi;
  }
  return count;
}

int crossings(const StraightWay& x, const std::array<StraightWay, 3>& corners, double tolerance,
              std::array<double, 3>& found) {
  const auto& [a, b, c] = corners;
  const Vec3 b0 = b.from - a.from, c0 = c.from - a.from, x0 = x.from - a.from;
  const Vec3 b1 = b.to - a.to - b0, c1 = c.to - a.to - c0, x1 = x.to - a.to - x0;
  const Vec3 n0 = b0.cross(c0), n1 = b0.cross(c1) + b1.cross(c0), n2 = b1.cross(c1);
  const std::array<double, 4> cubic = {n0.dot(x0), n0.dot(x1) + n1.dot(x0), n1.dot(x1) + n2.dot(x0),
                                       n2.dot(x1)};
  // The point stays in the plane all the way, up to rounding.
  const double longest = std::max({b0.norm(), c0.norm(), (b0 + b1).norm(), (c0 + c1).norm()});
  const double farthest = std::max(x0.norm(), (x0 + x1).norm());
  if (std::abs(cubic[0]) + std::abs(cubic[1]) + std::abs(cubic[2]) + std::abs(cubic[3]) <=
      1e-15 * longest * longest * farthest)
    return 0;
  std::array<double, 3> roots;
  const int root_count = roots_of_cubic(cubic, roots);
  int count = 0;
  for (int k = 0; k < root_count; ++k) {
    const Vec3 p = x.at(roots[k]);
    const Vec3 nearest = closest_on_triangle(p, a.at(roots[k]), b.at(roots[k]), c.at(roots[k])).first;
    if ((p - nearest).squaredNorm() <= tolerance * tolerance) found[count++] = roots[k];
  }
  return count;
}

double steepness(const StraightWay& x, const std::array<StraightWay, 3>& corners, double s) {
  const Vec3 a = corners[0].at(s), b = corners[1].at(s), c = corners[2].at(s), p = x.at(s);
  const auto [nearest, feature] = closest_on_triangle(p, a, b, c);
  const Vec3 weights = weights_on_triangle(nearest, feature, a, b, c);
  Vec3 way = x.to - x.from;
  for (int k = 0; k < 3; ++k) way -= weights[k] * (corners[k].to - corners[k].from);
  const Vec3 n = twice_area_normal(a, b, c);
  return n.dot(way) / (n.norm() * way.norm());
}

}  // namespace drape::internal
