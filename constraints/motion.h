// The prescribed motion of a rigid body: where it is at every time.
//   x = c + R(t) (X - c) + d(t),   c: the centre that the body turns about, d: translation [m], t [s]
// Steady: d = v tau, R = exp(w tau), tau: the time since the start, v [m/s], w [rad/s, along the axis].
//
// Keyframes: place and turn are C1, pass through every keyframe, and rest before the first and after the
// last.
//   d   a cubic of Hermite for each coordinate in each interval
//   R   = R_k exp(b1 h m_k/3) exp(b2 (W - h m_k/3 - h m_k+1/3)) exp(b2 e) exp(b3 h m_k+1/3),
//       b1 = 1 - (1-s)^3, b2 = 3 s^2 - 2 s^3, b3 = s^3        [Kim, Kim & Shin 1995, Hermite]
// with s = (t - t_k)/h; W [rad] is the turn from keyframe k to k+1 and m [rad/s] the spin at a keyframe, both
// as the body sees them; e is what is left to R_k+1 because turns about different axes do not commute. About
// one axis e = 0, and the angle follows the same cubic as a coordinate.
//
// The slopes, of a coordinate or of the spin about an axis of the body, are those of Fritsch & Butland 1984:
//   0 where the mean slopes D of the two intervals differ in sign, at the first and at the last keyframe,
//   else (w1 + w2) / (w1/D_k-1 + w2/D_k),  w1 = h_k-1 + 2 h_k,  w2 = 2 h_k-1 + h_k
// Nothing overshoots with them: the body rests where a keyframe is an extreme.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <variant>
#include <vector>

#include "constraints/pose.h"

namespace drape {

// A rotation vector (axis times angle) counts whole turns: between two vectors along the same axis the angle
// runs from one to the other, so that 0 to 4 pi turns twice. Between different axes the body turns the short
// way.
struct Keyframe {
  double time = 0;                // s
  Vec3 translate = Vec3::Zero();  // m
  Vec3 rotation = Vec3::Zero();   // rad
};

class Motion {
 public:
  Motion() = default;  // the body stands where it was drawn

  // Both throw InputError when a value is not finite, when the end comes before the start, and when there are
  // no keyframes or they are out of order. A constant motion goes from start to end; before, the body stands
  // where it was drawn, and after, where it has arrived.
  static Motion constant(const Vec3& velocity, const Vec3& spin, const Vec3& centre, double start = 0,
                         double end = std::numeric_limits<double>::infinity());
  static Motion keyframes(const std::vector<Keyframe>& keyframes, const Vec3& centre);

  Pose at(double time) const;  // allocates nothing
  bool moves() const;          // false: at() is one pose at all times, though perhaps not the default one
  // The time from which on the body stands [s]: 0 when it never moves, infinity when it never stops.
  double last_time() const;

 private:
  struct Steady {
    Vec3 velocity, spin, centre;
    double start, end;
    Pose at(double time) const;
  };
  // A keyframe, and how the motion goes on from it to the next one.
  struct Knot {
    double time;
    Vec3 translate, velocity;
    Eigen::Quaterniond rotation;
    Vec3 leaving = Vec3::Zero(), turning = Vec3::Zero(), left = Vec3::Zero(), arriving = Vec3::Zero();  // rad
  };
  struct Path {
    std::vector<Knot> knots;
    Vec3 centre;
    bool moves;
    Pose at(double time) const;
  };

  std::variant<std::monostate, Steady, Path> law_;
};

// Throws InputError unless the second keyframe comes later than the first.
void check_order(const Keyframe& before, const Keyframe& next);

// Of the rotation vectors (theta + 2 pi k) n that mean this rotation, returns the one nearest to `before`.
Vec3 unwrapped(const Eigen::Quaterniond& rotation, const Vec3& before);

}  // namespace drape
