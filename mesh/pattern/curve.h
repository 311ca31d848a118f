// Plane curves as they occur in drawings: straight lines, cubic Bezier curves, arcs of ellipses.
//   line    x(t) = (1 - t) p0 + t p1
//   cubic   x(t) = (1 - t)^3 p0 + 3 (1 - t)^2 t p1 + 3 (1 - t) t^2 p2 + t^3 p3
//   arc     x(t) = p0 + cos(a) p1 + sin(a) p2,   a = angle + t sweep [rad]; p0: centre, p1, p2: half axes
// t is in [0, 1]. An affine map of the points p maps the curve. A quadratic Bezier curve is stored as the
// cubic one that is the same curve.
#pragma once

#include <array>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

struct Segment {
  enum class Kind { line, cubic, arc };
  Kind kind = Kind::line;
  Vec2 start, end;  // x(0) and x(1), exactly
  // The points p0 .. p3 of a cubic, or the centre and the half axes of an arc.
  std::array<Vec2, 4> p = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
  double angle = 0, sweep = 0;  // rad, of an arc
};

Segment line_segment(const Vec2& start, const Vec2& end);
Segment cubic_segment(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3);
Segment quadratic_segment(const Vec2& p0, const Vec2& p1, const Vec2& p2);
// An arc from start to end with the parameters of SVG. rx and ry are the half axes (both are enlarged when
// the ellipse is too small to reach both points). `turn` [rad] is the angle from x to the first axis. `large`
// takes the longer way round. `counter_clockwise` is as seen with y upwards. The result is a straight line
// when rx or ry is zero.
Segment arc_segment(const Vec2& start, const Vec2& end, double rx, double ry, double turn, bool large,
                    bool counter_clockwise);

bool is_point(const Segment& segment);  // true when it has no length

// Maps every point x of the segment to matrix x + shift.
Segment mapped(const Segment& segment, const Eigen::Matrix2d& matrix, const Vec2& shift);
Segment reversed(const Segment& segment);

Vec2 point(const Segment& segment, double t);
Vec2 derivative(const Segment& segment, double t);
// Unit vector along the curve at its start or end; zero when the segment is a point.
Vec2 direction(const Segment& segment, bool at_end);

// The arc length of several segments, end to end, and the points at given fractions of it.
class ArcLength {
 public:
  explicit ArcLength(std::vector<Segment> segments);
  double length() const { return sums_.back(); }
  double end_of(std::size_t segment) const;  // fraction at which this segment ends
  Vec2 at(double fraction) const;            // at the ends of segments it is exact
  const std::vector<Segment>& segments() const { return segments_; }

 private:
  static constexpr int kParts = 32;  // equal parts in t, of each segment
  std::vector<Segment> segments_;
  // A zero, then for every part (kParts in each segment) the length from the start to the end of that part.
  std::vector<double> sums_;
};

}  // namespace drape
