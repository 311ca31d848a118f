// Plane curves as drawings have them: straight lines, cubic Bezier curves, arcs of ellipses.
//   line    x(t) = (1 - t) p0 + t p1
//   cubic   x(t) = (1 - t)^3 p0 + 3 (1 - t)^2 t p1 + 3 (1 - t) t^2 p2 + t^3 p3
//   arc     x(t) = p0 + cos(a) p1 + sin(a) p2,   a = angle + t sweep [rad]; p0: centre, p1, p2: half axes
// t in [0, 1]. An affine map of the points maps the curve. Quadratic curves are raised to cubic ones, which
// are the same curve.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace drape {

using Vec2 = Eigen::Vector2d;

struct Segment {
  enum class Kind { line, cubic, arc };
  Kind kind = Kind::line;
  Vec2 start, end;                                                                   // x(0) and x(1), exactly
  std::array<Vec2, 4> p = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};  // of cubic and arc
  double angle = 0, sweep = 0;                                                       // rad, of an arc
};

Segment line_segment(const Vec2& start, const Vec2& end);
Segment cubic_segment(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3);
Segment quadratic_segment(const Vec2& p0, const Vec2& p1, const Vec2& p2);
// From start to end as SVG says it: half axes rx and ry (made larger where they are too short to reach), the
// first turned by `turn` [rad] from x; the long way round or not; counter-clockwise where y points up or not.
// A straight line where rx or ry is zero.
Segment arc_segment(const Vec2& start, const Vec2& end, double rx, double ry, double turn, bool large,
                    bool counter_clockwise);

bool is_point(const Segment& segment);  // has no length

Segment mapped(const Segment& segment, const Eigen::Matrix2d& matrix, const Vec2& shift);
Segment reversed(const Segment& segment);

Vec2 point(const Segment& segment, double t);
Vec2 derivative(const Segment& segment, double t);
Vec2 direction(const Segment& segment, bool at_end);  // unit, along the curve; zero where it is a point

// Arc length of several segments, end to end, and the points at fractions of it.
class ArcLength {
 public:
  explicit ArcLength(std::vector<Segment> segments);
  double length() const { return sums_.back(); }
  double end_of(std::size_t segment) const;  // fraction at which a segment ends
  Vec2 at(double fraction) const;            // exact at the ends of segments
  const std::vector<Segment>& segments() const { return segments_; }

 private:
  static constexpr int kParts = 32;  // of each segment, by t
  std::vector<Segment> segments_;
  std::vector<double> sums_;  // length up to each part; kParts for each segment, after a zero
};

}  // namespace drape
