#include "mesh/pattern/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape {
namespace {

// The arc length between a and b by the Gauss-Legendre rule with five points.
double arc_length(const Segment& s, double a, double b) {
  constexpr double x[3] = {0, 0.5384693101056831, 0.9061798459386640};
  constexpr double w[3] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = (a + b) / 2, half = (b - a) / 2;
  double sum = w[0] * derivative(s, middle).norm();
  for (int i = 1; i < 3; ++i)
    sum += w[i] * (derivative(s, middle - half * x[i]).norm() + derivative(s, middle + half * x[i]).norm());
  return half * sum;
}

}  // namespace

Segment line_segment(const Vec2& start, const Vec2& end) {
  Segment s;
  s.start = start, s.end = end;
  return s;
}

Segment cubic_segment(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
  Segment s = line_segment(p0, p3);
  s.kind = Segment::Kind::cubic;
  s.p = {p0, p1, p2, p3};
  return s;
}

Segment quadratic_segment(const Vec2& p0, const Vec2& p1, const Vec2& p2) {
  return cubic_segment(p0, p0 + 2.0 / 3 * (p1 - p0), p2 + 2.0 / 3 * (p1 - p2), p2);
}

// Computes the centre and the angles of an arc as in SVG 1.1, appendix F.6.5 and F.6.6.
Segment arc_segment(const Vec2& start, const Vec2& end, double rx, double ry, double turn, bool large,
                    bool counter_clockwise) {
  rx = std::abs(rx), ry = std::abs(ry);
  if (rx == 0 || ry == 0 || start == end) return line_segment(start, end);
  const double c = std::cos(turn), s = std::sin(turn);
  Eigen::Matrix2d axes;
  axes << c * rx, -s * ry, s * rx, c * ry;  // maps the unit circle to the ellipse
  Eigen::Matrix2d inverse;
  inverse << c / rx, s / rx, -s / ry, c / ry;
  const Vec2 a = inverse * start, b = inverse * end, half = (b - a) / 2;
  double radius = 1, off = 1 - half.squaredNorm();
  if (off < 0) radius = half.norm(), off = 0;
  const double side = large == counter_clockwise ? -1 : 1;
  const Vec2 across(-half.y(), half.x());
  const Vec2 centre = (a + b) / 2 + side * std::sqrt(off) / half.norm() * across;
  const double from = std::atan2(a.y() - centre.y(), a.x() - centre.x());
  double sweep = std::atan2(b.y() - centre.y(), b.x() - centre.x()) - from;
  if (counter_clockwise && sweep < 0) sweep += 2 * std::numbers::pi;
  if (!counter_clockwise && sweep > 0) sweep -= 2 * std::numbers::pi;
  Segment arc = line_segment(start, end);
  arc.kind = Segment::Kind::arc;
  arc.p = {axes * centre, radius * axes.col(0), radius * axes.col(1), Vec2::Zero()};
  arc.angle = from, arc.sweep = sweep;
  return arc;
}

bool is_point(const Segment& s) {
  if (s.kind == Segment::Kind::arc) return s.sweep == 0;
  return s.start == s.end && (s.kind == Segment::Kind::line || (s.p[1] == s.start && s.p[2] == s.start));
}

Segment mapped(const Segment& segment, const Eigen::Matrix2d& matrix, const Vec2& shift) {
  Segment s = segment;
  s.start = matrix * s.start + shift, s.end = matrix * s.end + shift;
  for (std::size_t i = 0; i < 4; ++i) {
    s.p[i] = matrix * s.p[i];
    if (s.kind == Segment::Kind::cubic || i == 0) s.p[i] += shift;  // half axes turn but do not shift
  }
  return s;
}

Segment reversed(const Segment& segment) {
  Segment s = segment;
  std::swap(s.start, s.end);
  if (s.kind == Segment::Kind::cubic) std::reverse(s.p.begin(), s.p.end());
  s.angle = segment.angle + segment.sweep, s.sweep = -segment.sweep;
  return s;
}

Vec2 point(const Segment& s, double t) {
  if (t <= 0) return s.start;
  if (t >= 1) return s.end;
  if (s.kind == Segment::Kind::line) return (1 - t) * s.start + t * s.end;
  if (s.kind == Segment::Kind::arc) {
    const double a = s.angle + t * s.sweep;
    return s.p[0] + std::cos(a) * s.p[1] + std::sin(a) * s.p[2];
  }
  const double u = 1 - t;
  return u * u * u * s.p[0] + 3 * u * u * t * s.p[1] + 3 * u * t * t * s.p[2] + t * t * t * s.p[3];
}

Vec2 derivative(const Segment& s, double t) {
  if (s.kind == Segment::Kind::line) return s.end - s.start;
  if (s.kind == Segment::Kind::arc) {
    const double a = s.angle + t * s.sweep;
    return s.sweep * (std::cos(a) * s.p[2] - std::sin(a) * s.p[1]);
  }
  const double u = 1 - t;
  return 3 * u * u * (s.p[1] - s.p[0]) + 6 * u * t * (s.p[2] - s.p[1]) + 3 * t * t * (s.p[3] - s.p[2]);
}

// Where control points coincide, the derivative vanishes at the end but the direction does not.
Vec2 direction(const Segment& s, bool at_end) {
  double t = 0;  // then 1e-6, 1e-5, ... 1
  while (t <= 1) {
    const Vec2 d = derivative(s, at_end ? 1 - t : t);
    if (d.norm() > 1e-9 * (s.end - s.start).norm() + 1e-300) return d.normalized();
    t = t == 0 ? 1e-6 : 10 * t;
  }
  return Vec2::Zero();
}

ArcLength::ArcLength(std::vector<Segment> segments) : segments_(std::move(segments)), sums_{0} {
  sums_.reserve(segments_.size() * kParts + 1);
  for (const Segment& s : segments_)
    for (int i = 0; i < kParts; ++i)
      sums_.push_back(sums_.back() + arc_length(s, double(i) / kParts, double(i + 1) / kParts));
}

double ArcLength::end_of(std::size_t segment) const {
  return segment + 1 == segments_.size() ? 1 : sums_[(segment + 1) * kParts] / length();
}

Vec2 ArcLength::at(double fraction) const {
  const double wanted = fraction * length();
  const auto above = std::upper_bound(sums_.begin(), sums_.end(), wanted);
  const std::size_t part = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      above - sums_.begin() - 1, 0, static_cast<std::ptrdiff_t>(sums_.size()) - 2));
  const Segment& s = segments_[part / kParts];
  const double t0 = double(part % kParts) / kParts, t1 = t0 + 1.0 / kParts;
  const double goal = wanted - sums_[part], whole = sums_[part + 1] - sums_[part];
  double t = whole > 0 ? t0 + (t1 - t0) * std::clamp(goal / whole, 0.0, 1.0) : t0;
  if (s.kind != Segment::Kind::line) {
    for (int i = 0; i < 8; ++i) {  // Newton; the start is off only by the curvature within one part
      const double speed = derivative(s, t).norm();
      if (!(speed > 0)) break;
      const double step = (goal - arc_length(s, t0, t)) / speed;
      t = std::clamp(t + step, t0, t1);
      if (std::abs(step) < 1e-15) break;
    }
  }
  if (t < 1e-12) return s.start;
  if (t > 1 - 1e-12) return s.end;
  return point(s, t);
}

}  // namespace drape
