// Impulses between bodies at the points where they touch, all found together by sweeps over the points (projected Gauss-Seidel),
// each of which goes on along the way of those before it, as conjugate gradients do.          [Silcowitz, Niebe & Erleben 2010]
//   u = sum (s v + w x r) - u_0      relative velocity at a point, over the bodies that have a part in it
//   K = sum (s^2/M 1 - [r] I^-1 [r]);   the impulse J there changes s J / M of a body's v and I^-1 (r x J) of its w
//   n.u >= target,  J.n >= 0,  one of the two with equality;  |J_T| <= mu J.n, and against the slip where that is reached
// A substep has up to three phases. Each begins with the velocities that those before it have left:
//   impact     from the velocities with which the substep begins
//   support    from those that the forces and the impact make
//   recovery   without friction, for what lies too deep. It is a motion within the substep that leaves no velocity.
// s [-]: the part of the body in the point, below 0 on the other side of it. r [m]: s times the way from its centre.
// u, u_0, v [m/s], w [rad/s], J [N s], K [1/kg], M [kg], I [kg m^2].
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/forces/cluster_body.h"

namespace drape {

enum class Phase { impact, support, recovery };

class Impulses {
 public:
  static inline const ClusterMotion at_rest = {Vec3::Zero(), Vec3::Zero()};
  struct Body {
    double inverse_mass;                                                 // 1/kg; 0: it gives way to nothing
    Mat3 inverse_inertia;                                                // 1/(kg m^2)
    ClusterMotion before;                                                // when the substep begins
    ClusterMotion free;                                                  // at its end without impulses
    ClusterMotion now = at_rest;                                         // in the phase under way
    std::array<ClusterMotion, 3> changes = {at_rest, at_rest, at_rest};  // by phase

    const ClusterMotion& change(Phase phase) const { return changes[static_cast<std::size_t>(phase)]; }
    ClusterMotion start_of(Phase phase) const;  // its motion when the phase begins
    ClusterMotion after(Phase phase) const { return start_of(phase) + change(phase); }
  };
  struct Hold {  // the part of a body in a point
    int body;
    double share;  // s
    Vec3 arm;      // r
  };
  struct Point {
    int first = 0, last = 0;                 // of its holds
    Vec3 normal;                             // n, unit
    Vec3 surface;                            // u_0
    double mu = 0, target = 0;               // -, m/s, in the phase under way
    Vec3 impulse = Vec3::Zero();             // J in that phase
    Vec3 more = Vec3::Zero();                // by which the last sweep changed it [N s]
    Vec3 guess = Vec3::Zero();               // of J, with which the sweeps of the support begin [N s]
    Vec3 way = Vec3::Zero();                 // along which the sweeps go [N s]
    double give_along = 0, give_across = 0;  // 1/kg, n.K n, and at most across n
  };

  void reserve(std::size_t bodies, std::size_t points);
  void clear();
  int add(const Body& body);
  // Adds the part of a body to the point that is made next; parts of the same body are summed.
  void hold(int body, double share, const Vec3& arm);
  Point& add_point(const Vec3& normal, const Vec3& surface);

  std::vector<Body>& bodies() { return bodies_; }
  const std::vector<Body>& bodies() const { return bodies_; }
  std::vector<Point>& points() { return points_; }
  std::span<const Hold> holds(const Point& point) const {
    return {holds_.data() + point.first, static_cast<std::size_t>(point.last - point.first)};
  }

  void begin(Phase phase);              // all impulses of the phase are zero
  Vec3 slip(const Point& point) const;  // u [m/s] in the phase under way
  // Returns how much of the largest velocity of the phases so far the last sweep still changed; about 1e-9 where the impulses
  // have settled.
  double settle(Phase phase);

 private:
  void push(const Point& point, const Vec3& impulse);
  double sweep(bool rubs);
  void take_guess();
  void go_on(double share);

  std::vector<Body> bodies_;
  std::vector<Hold> holds_;
  std::vector<Point> points_;
  double fastest_ = 0;  // m/s
};

}  // namespace drape
