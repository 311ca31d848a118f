#include "solver/forces/impulses.h"

#include <algorithm>

namespace drape {
namespace {

constexpr int most_sweeps = 200;
constexpr double exactness = 1e-9;  // of the largest velocity: what a sweep changes at the end

}  // namespace

ClusterMotion Impulses::Body::start_of(Phase phase) const {
  if (phase == Phase::impact) return before;
  const ClusterMotion forced = free + change(Phase::impact);
  return phase == Phase::support ? forced : forced + change(Phase::support);
}

void Impulses::reserve(std::size_t bodies, std::size_t points) {
  bodies_.reserve(bodies);
  points_.reserve(points);
  holds_.reserve(4 * points);
}

void Impulses::clear() {
  bodies_.clear();
  holds_.clear();
  points_.clear();
  fastest_ = 0;
}

int Impulses::add(const Body& body) {
  bodies_.push_back(body);
  return static_cast<int>(bodies_.size()) - 1;
}

void Impulses::hold(int body, double share, const Vec3& arm) {
  const auto first = holds_.begin() + (points_.empty() ? 0 : points_.back().last);
  const auto same = std::find_if(first, holds_.end(), [body](const Hold& h) { return h.body == body; });
  if (same == holds_.end()) {
    holds_.push_back({body, share, arm});
    return;
  }
  same->share += share;
  same->arm += arm;
}

Impulses::Point& Impulses::add_point(const Vec3& normal, const Vec3& surface) {
  Point point{.first = points_.empty() ? 0 : points_.back().last,
              .last = static_cast<int>(holds_.size()),
              .normal = normal,
              .surface = surface};
  double trace = 0;
  for (const Hold& hold : holds(point)) {
    const Body& body = bodies_[static_cast<std::size_t>(hold.body)];
    const Vec3 turn = hold.arm.cross(normal);
    point.give_along += hold.share * hold.share * body.inverse_mass + turn.dot(body.inverse_inertia * turn);
    trace += 3 * hold.share * hold.share * body.inverse_mass +
             hold.arm.squaredNorm() * body.inverse_inertia.trace() -
             hold.arm.dot(body.inverse_inertia * hold.arm);
  }
  point.give_across = trace - point.give_along;
  return points_.emplace_back(point);
}

void Impulses::take_guess() {
  for (Point& point : points_) {
    point.impulse = point.guess;
    push(point, point.guess);
  }
}

void Impulses::begin(Phase phase) {
  for (Body& body : bodies_) body.now = body.start_of(phase);
  for (Point& point : points_) {
    point.impulse.setZero();
    point.way.setZero();
  }
}

Vec3 Impulses::slip(const Point& point) const {
  Vec3 u = -point.surface;
  for (const Hold& hold : holds(point)) {
    const ClusterMotion& now = bodies_[static_cast<std::size_t>(hold.body)].now;
    u += hold.share * now.velocity + now.spin.cross(hold.arm);
  }
  return u;
}

void Impulses::push(const Point& point, const Vec3& impulse) {
  for (const Hold& hold : holds(point)) {
    Body& body = bodies_[static_cast<std::size_t>(hold.body)];
    body.now.velocity += hold.share * body.inverse_mass * impulse;
    body.now.spin += body.inverse_inertia * hold.arm.cross(impulse);
  }
}

// Corrects every impulse once; returns the largest change of a velocity [m/s].
double Impulses::sweep(bool rubs) {
  double largest = 0;
  for (Point& point : points_) {
    const Vec3& n = point.normal;
    const Vec3 u = slip(point);
    const double before = point.impulse.dot(n),
                 along = std::max(0.0, before + (point.target - u.dot(n)) / point.give_along);
    Vec3 across = Vec3::Zero();
    if (rubs && point.mu > 0) {
      across = point.impulse - before * n - (u - u.dot(n) * n) / point.give_across;
      const double most = point.mu * along, size = across.norm();
      if (size > most) across *= most / size;
    }
    point.more = along * n + across - point.impulse;
    point.impulse += point.more;
    push(point, point.more);
    largest = std::max(largest, point.more.norm() * (point.give_along + point.give_across));
  }
  return largest;
}

// Goes on along the way of the sweeps before, by this share of it, and turns the way towards the last sweep.
void Impulses::go_on(double share) {
  for (Point& point : points_) {
    const Vec3 further = share * point.way;
    point.impulse += further;
    push(point, further);
    point.way = further + point.more;
  }
}

double Impulses::settle(Phase phase) {
  double change = 0, last = 0;
  for (const Point& point : points_)
    fastest_ = std::max(fastest_, slip(point).norm() + std::max(0.0, point.target));
  if (phase == Phase::support) take_guess();
  for (int k = 0; k < most_sweeps; ++k) {
    change = sweep(phase != Phase::recovery);
    if (change <= exactness * fastest_ || k + 1 == most_sweeps) break;
    double size = 0;  // of the sweep, as an energy [J]
    for (const Point& point : points_) size += point.give_along * point.more.squaredNorm();
    go_on(size < last ? size / last : 0);
    last = size;
  }
  for (Body& body : bodies_) {
    const ClusterMotion start = body.start_of(phase);
    body.changes[static_cast<std::size_t>(phase)] = {body.now.velocity - start.velocity,
                                                     body.now.spin - start.spin};
  }
  return fastest_ > 0 ? change / fastest_ : 0;
}

}  // namespace drape
