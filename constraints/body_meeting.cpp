#include "constraints/body_meeting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/base/errors.h"

namespace drape {
namespace {

constexpr double look_ahead = 1e-3;  // m: touches are found this much earlier than speeds ask for
constexpr double same_place = 0.1;   // share of the smaller body within which a touch is known again
constexpr double slides = 1e-4;      // m/s: slower, the static friction holds
constexpr double well_apart = 1e-9;  // m: a surface that is nearer than rest_gap by less is left there

double mean(double a, double b) { return std::sqrt(a * b); }

std::string kind_of(const MovingBody& body) { return std::string(name(body.obstacle().shape)); }

// The speed of the fastest point of a body in the step under way [m/s].
double fastest(const MovingBody& body, const TouchForm& form) {
  const double reach = std::isfinite(form.reach()) ? form.reach() : 0;
  if (const ReactingBody* const r = body.reacting())
    return r->free_velocity().norm() +
           r->free_spin().norm() * (reach + (body.start().to_world(form.middle()) - r->centre()).norm());
  return body.fastest_carried(form.middle(), reach);
}

}  // namespace

void BodyMeeting::add(const Bodies& bodies) {
  const auto reacts = [](const MovingBody& body) { return body.reacting() != nullptr; };
  if (bodies.size() < 2 || std::none_of(bodies.begin(), bodies.end(), reacts)) return;
  while (forms_.size() < bodies.size()) forms_.emplace_back(bodies[forms_.size()].obstacle().shape);
  movers_.resize(bodies.size());
  apart_.resize(bodies.size());
  if (Hull::available()) return;
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b)
      if ((reacts(bodies[a]) || reacts(bodies[b])) && needs_hulls(forms_[a], forms_[b]))
        throw InputError(
            "a " + kind_of(bodies[a]) + " and a " + kind_of(bodies[b]) +
            ", of which one has a mass: this build is without the library by which such bodies meet; on "
            "Debian or Ubuntu: apt install libbullet-dev, and build again");
}

void BodyMeeting::begin_step(Bodies& bodies, std::vector<Nip>& nips, double h, double recovery_speed) {
  meetings_.clear();
  settled_ = true;
  if (forms_.empty()) return;
  h_ = h;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    movers_[k] = {};
    const ReactingBody* const r = bodies[k].reacting();
    if (!r) continue;
    movers_[k].reacts = true;
    movers_[k].inverse_mass = 1 / r->mass();
    movers_[k].inverse_inertia = r->inverse_inertia();
    movers_[k].centre = r->centre();
  }
  take_free(bodies);
  find(bodies, h);
  for (std::size_t k = 0; k < nips.size(); ++k) add_nip(bodies, nips, static_cast<int>(k));
  if (meetings_.empty()) return;
  recall(bodies, nips, last_h_ > 0 ? h / last_h_ : 0);
  push_apart(h, recovery_speed);
  sweep_until_settled();
  give(bodies, nips);
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (movers_[k].meets && movers_[k].reacts) bodies[k].expect(apart_[k].first, apart_[k].second);
}

void BodyMeeting::find(const Bodies& bodies, double h) {
  double speed = 0;
  for (std::size_t k = 0; k < bodies.size(); ++k) speed = std::max(speed, fastest(bodies[k], forms_[k]));
  const double reach = look_ahead + 4 * h * speed;
  const int n = static_cast<int>(bodies.size());
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      if (!movers_[a].reacts && !movers_[b].reacts) continue;
      find_touches(bodies[a], forms_[a], bodies[b], forms_[b], reach, touches_);
      for (const Touch& touch : touches_) add_touch(bodies, a, b, touch);
    }
}

// Cloth between two surfaces gives way, so it does not throw them back, and it goes along with the one that
// holds it.
void BodyMeeting::add_nip(const Bodies& bodies, const std::vector<Nip>& nips, int number) {
  const Nip& nip = nips[static_cast<std::size_t>(number)];
  Meeting& m = add_touch(bodies, nip.a, nip.b, nip.touch);
  const Friction& mu = bodies[nip.other()].obstacle().friction;
  m.nip = number;
  m.mu = nip.runs ? 0 : m.slides ? mu.kinetic : mu.statics;
  m.rebound = 0;
}

BodyMeeting::Meeting& BodyMeeting::add_touch(const Bodies& bodies, int a, int b, const Touch& touch) {
  Mover &one = movers_[a], &other = movers_[b];
  const Obstacle &oa = bodies[a].obstacle(), &ob = bodies[b].obstacle();
  Meeting m{};
  m.a = a;
  m.b = b;
  m.nip = -1;
  m.normal = touch.normal;
  m.gap = touch.gap;
  m.t1 = m.normal.unitOrthogonal();
  m.t2 = m.normal.cross(m.t1);
  m.arm_a = touch.place - one.centre;
  m.arm_b = touch.place - other.centre;
  m.carried.setZero();
  if (!one.reacts) m.carried += bodies[a].velocity(touch.place);
  if (!other.reacts) m.carried -= bodies[b].velocity(touch.place);
  m.mark = bodies[a].start().to_body(touch.place);
  one.meets = other.meets = true;

  Vec3 before = m.carried;  // the relative velocity when the step begins
  if (one.reacts) before += bodies[a].reacting()->velocity() + bodies[a].reacting()->spin().cross(m.arm_a);
  if (other.reacts) before -= bodies[b].reacting()->velocity() + bodies[b].reacting()->spin().cross(m.arm_b);
  const double s = -before.dot(m.normal);
  m.slides = (before + s * m.normal).norm() > slides;
  m.mu = m.slides ? mean(oa.friction.kinetic, ob.friction.kinetic)
                  : mean(oa.friction.statics, ob.friction.statics);
  // What rests falls a little in every step, which is no impact.
  double fall = 0;
  for (const MovingBody* body : {&bodies[a], &bodies[b]})
    if (body->reacting()) fall = std::max(fall, h_ * body->reacting()->gravity().norm());
  const bool impact = s > 2 * fall && h_ * s > m.gap - rest_gap;
  m.rebound = impact ? mean(oa.restitution, ob.restitution) * s : 0;

  // The velocity at the touch for an impulse of 1 N s:  K = sum 1/m - [r] I^-1 [r]
  const auto answer = [&m, &one, &other](const Vec3& d) {
    Vec3 u = (one.inverse_mass + other.inverse_mass) * d;
    u += (one.inverse_inertia * m.arm_a.cross(d)).cross(m.arm_a);
    u += (other.inverse_inertia * m.arm_b.cross(d)).cross(m.arm_b);
    return u;
  };
  const Vec3 k1 = answer(m.t1), k2 = answer(m.t2);
  const double k11 = k1.dot(m.t1), k12 = k1.dot(m.t2), k22 = k2.dot(m.t2);
  m.k_n = answer(m.normal).dot(m.normal);
  m.k_t = (k11 + k22) / 2 + std::hypot((k11 - k22) / 2, k12);
  m.lambda.setZero();
  meetings_.push_back(m);
  return meetings_.back();
}

// Begins with the impulses of the last step. share: the length of this step over that of the last.
void BodyMeeting::recall(const Bodies& bodies, const std::vector<Nip>& nips, double share) {
  for (Kept& kept : kept_) kept.taken = false;
  for (Meeting& m : meetings_) {
    double least = same_place * std::min(forms_[m.a].reach(), forms_[m.b].reach());
    Kept* nearest = nullptr;
    for (Kept& kept : kept_) {
      if (kept.taken || kept.a != m.a || kept.b != m.b || kept.particle != particle_of(m, nips)) continue;
      const double away = (kept.mark - m.mark).norm();
      if (away < least) nearest = &kept, least = away;
    }
    if (!nearest) continue;
    nearest->taken = true;
    const Vec3 impulse = share * bodies[m.a].start().direction_to_world(nearest->impulse);
    m.lambda = {std::max(impulse.dot(m.normal), 0.0), impulse.dot(m.t1), impulse.dot(m.t2)};
  }
}

// Reads the motion that the bodies would have without each other; true when it is another than before.
bool BodyMeeting::take_free(const Bodies& bodies) {
  bool changed = false;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const ReactingBody* const r = bodies[k].reacting();
    if (!r) continue;
    const Vec3 v = r->free_velocity(), w = r->free_spin();
    Mover& mover = movers_[k];
    changed = changed || (mover.meets && (v != mover.free_v || w != mover.free_w));
    mover.free_v = v;
    mover.free_w = w;
  }
  return changed;
}

void BodyMeeting::solve(Bodies& bodies, std::vector<Nip>& nips) {
  if (meetings_.empty() || !take_free(bodies)) return;
  sweep_until_settled();
  give(bodies, nips);
}

void BodyMeeting::show(std::vector<BodyTouch>& touches) const {
  touches.clear();
  for (const Meeting& m : meetings_) {
    const int reacts = movers_[m.a].reacts ? m.a : m.b;
    const Vec3 place = movers_[reacts].centre + (reacts == m.a ? m.arm_a : m.arm_b);
    touches.push_back({m.a, m.b, place, m.normal, m.carried, m.mu, m.target, m.impulse()});
  }
}

Vec3 BodyMeeting::Meeting::impulse() const { return lambda[0] * normal + lambda[1] * t1 + lambda[2] * t2; }

void BodyMeeting::apply(const Meeting& m, const Vec3& impulse) {
  Mover &a = movers_[m.a], &b = movers_[m.b];
  a.v += a.inverse_mass * impulse;
  a.w += a.inverse_inertia * m.arm_a.cross(impulse);
  b.v -= b.inverse_mass * impulse;
  b.w -= b.inverse_inertia * m.arm_b.cross(impulse);
}

Vec3 BodyMeeting::slip(const Meeting& m) const {
  const Mover &a = movers_[m.a], &b = movers_[m.b];
  return a.v + a.w.cross(m.arm_a) - b.v - b.w.cross(m.arm_b);
}

void BodyMeeting::sweep_until_settled() {
  double speed = 0, fastest_body = 0;  // of the surfaces against each other; of a body
  for (Mover& mover : movers_) {
    mover.v = mover.free_v;
    mover.w = mover.free_w;
    fastest_body = std::max(fastest_body, mover.v.norm());
  }
  for (const Meeting& m : meetings_) speed = std::max(speed, (slip(m) + m.carried).norm());
  for (const Meeting& m : meetings_) apply(m, m.impulse());
  constexpr double round_off = 4e-15, near_enough = 1e-3;
  constexpr double still = 1e-7;  // m/s
  const double noise = round_off * fastest_body;
  double change = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_sweeps && !(change <= std::max(exactness * speed, noise)); ++k) change = sweep();
  settled_ = change <= std::max(near_enough * speed, still);
}

// Goes once through all touches. Returns the largest change of velocity [m/s].
double BodyMeeting::sweep() {
  double largest = 0;
  for (Meeting& m : meetings_) {
    const Vec3 before = m.lambda;
    const double u = (slip(m) + m.carried).dot(m.normal);
    m.lambda[0] = std::max(0.0, m.lambda[0] - (u - m.target) / m.k_n);
    apply(m, (m.lambda[0] - before[0]) * m.normal);
    const Vec3 along = slip(m) + m.carried;
    Vec2 rub = m.lambda.tail<2>() - Vec2(along.dot(m.t1), along.dot(m.t2)) / m.k_t;
    const double most = m.mu * m.lambda[0], size = rub.norm();
    if (size > most) rub *= most / size;
    m.lambda.tail<2>() = rub;
    apply(m, (rub[0] - before[1]) * m.t1 + (rub[1] - before[2]) * m.t2);
    largest = std::max(
        {largest, m.k_n * std::abs(m.lambda[0] - before[0]), m.k_t * (rub - before.tail<2>()).norm()});
  }
  return largest;
}

// Finds what moves bodies apart that are nearer than rest_gap, and from that the targets of all touches.
void BodyMeeting::push_apart(double h, double recovery_speed) {
  for (auto& [u, w] : apart_) u.setZero(), w.setZero();
  bool near = false;
  for (const Meeting& m : meetings_) near = near || m.gap < rest_gap - well_apart;
  if (near) {
    for (Mover& mover : movers_) mover.v.setZero(), mover.w.setZero();
    std::vector<double>& pushes = pushes_;
    pushes.assign(meetings_.size(), 0.0);
    for (int k = 0; k < most_sweeps; ++k) {
      double largest = 0;
      for (std::size_t i = 0; i < meetings_.size(); ++i) {
        const Meeting& m = meetings_[i];
        const double wanted = std::min((rest_gap - m.gap) / h, recovery_speed);
        const double push = std::max(0.0, pushes[i] - (slip(m).dot(m.normal) - wanted) / m.k_n);
        largest = std::max(largest, m.k_n * std::abs(push - pushes[i]));
        apply(m, (push - pushes[i]) * m.normal);
        pushes[i] = push;
      }
      if (largest <= 1e-6 * recovery_speed) break;
    }
    for (std::size_t k = 0; k < movers_.size(); ++k) apart_[k] = {movers_[k].v, movers_[k].w};
  }
  for (Meeting& m : meetings_) {
    const double rise = near ? h * slip(m).dot(m.normal) : 0;
    m.target = m.rebound > 0 ? m.rebound : -std::max(0.0, m.gap - rest_gap + rise) / h;
  }
}

// Gives the bodies their impulses and the moments of these, and the nips what presses there.
void BodyMeeting::give(Bodies& bodies, std::vector<Nip>& nips) {
  for (Mover& mover : movers_) mover.impulse.setZero(), mover.moment.setZero();
  for (const Meeting& m : meetings_) {
    const Vec3 impulse = m.impulse();
    if (m.nip >= 0) nips[static_cast<std::size_t>(m.nip)].impulse = m.lambda[0];
    movers_[m.a].impulse += impulse;
    movers_[m.a].moment += m.arm_a.cross(impulse);
    movers_[m.b].impulse -= impulse;
    movers_[m.b].moment -= m.arm_b.cross(impulse);
  }
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (movers_[k].meets && movers_[k].reacts) bodies[k].meet(movers_[k].impulse, movers_[k].moment);
}

BodyMeetingReport BodyMeeting::end_step(const Bodies& bodies, const std::vector<Nip>& nips) {
  BodyMeetingReport report;
  report.settled = settled_;
  kept_.clear();
  last_h_ = h_;
  for (const Meeting& m : meetings_) {
    if (m.nip < 0) report.deepest = std::max(report.deepest, -m.gap);
    if (m.lambda[0] <= 0) continue;
    ++report.touches;
    kept_.push_back(
        {m.a, m.b, particle_of(m, nips), m.mark, bodies[m.a].start().direction_to_body(m.impulse())});
  }
  return report;
}

std::vector<BodyMeeting::Overlap> BodyMeeting::overlaps(const Bodies& bodies, double margin) {
  std::vector<Overlap> all;
  const int n = static_cast<int>(forms_.size());
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      if (!bodies[a].reacting() && !bodies[b].reacting()) continue;
      find_touches(bodies[a], forms_[a], bodies[b], forms_[b], 0, touches_);
      double depth = 0;
      for (const Touch& touch : touches_) depth = std::max(depth, -touch.gap);
      if (depth > margin) all.push_back({a, b, depth});
    }
  return all;
}

}  // namespace drape
