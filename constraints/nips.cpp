// Particles that two bodies pinch (constraints/nip.h), or the sides of a fold of one.
#include <algorithm>
#include <cmath>
#include <utility>

#include "constraints/particle_contacts.h"

namespace drape {
namespace {

// Two surfaces pinch what is between them where -n_a . n_b, of their outward normals, is at least this.
constexpr double facing = 0.9;
constexpr double still = 1e-9;  // m/s: a smaller slip is not told from none
// Bodies that leave too little room by more than this have closed on what is between them [m].
constexpr double closed = 1e-9;
// Two surfaces are nearest to each other where -n_a . n_b is at least this.
constexpr double opposite = 1 - 1e-6;
// Steps between two surfaces that come nearer to that place by less than this share lead too far to be
// foretold.
constexpr double slowest = 0.999;
// The angle between one normal and the opposite of another up to which their bodies hold what is between them
// even without friction [rad]: as much as the planes of one contact have to differ by.
constexpr double nearly_opposite = 0.1;
// The same with any friction: a body that pushes cloth along a floor does not hold it against that [rad].
constexpr double widest_held = 1.2;
// Bodies that stand hold what is inside both of their margins by more than this share of the lesser
// touching_range().
constexpr double share_of_touch = 0.1;

// How two bodies that do not react stand to a place that goes with both of them at the end of the step:
// across their surfaces by the mean of their ways, along them with the one that leads, or by the mean.
struct Squeeze {
  SurfacePoint at_a, at_b;  // there, with normals out of the bodies
  Vec3 way;                 // m/s
  bool closes;              // the bodies come nearer to each other
  bool holds;               // the friction of both keeps what is there from slipping out
};

// x [m]: the place when the step begins. leader: a, b, or null.
Squeeze squeeze(const MovingBody& a, const MovingBody& b, const MovingBody* leader, const Vec3& x) {
  const Vec3 v_a = a.velocity(x), v_b = b.velocity(x), mean = 0.5 * (v_a + v_b);
  Vec3 way = mean;
  if (leader && v_a != v_b) {
    const Vec3 place = x + a.step() * leader->velocity(x), beside_mean = leader->velocity(x) - mean;
    const Vec3 apart = a.near_end(place).normal - b.near_end(place).normal;
    if (apart.squaredNorm() > 0) way += beside_mean - apart.dot(beside_mean) / apart.squaredNorm() * apart;
  }
  const SurfacePoint at_a = a.near_end(x + a.step() * way), at_b = b.near_end(x + a.step() * way);
  const double held =
      std::atan(a.obstacle().friction.kinetic) + std::atan(b.obstacle().friction.kinetic);  // rad
  return {at_a, at_b, way, (v_a - v_b).dot(at_a.normal - at_b.normal) > still,
          -at_a.normal.dot(at_b.normal) >= std::cos(std::clamp(held, nearly_opposite, widest_held))};
}

// Whether two surfaces leave no room for what is between them. touch [m]: the lesser of their touching_range().
bool no_room(bool clamped, bool closes, double gap_a, double gap_b, double touch) {
  if (!clamped && closes) return gap_a + gap_b < -closed;
  return std::max(gap_a, gap_b) < (clamped ? -closed : -share_of_touch * touch);
}

// A contact that goes this way [m/s] between two surfaces.
Contact clamp(int particle, const ContactPlane& a, const ContactPlane& b, const Vec3& way) {
  Contact contact{.particle = particle, .planes = 1, .known = 1, .plane = {}, .clamped = true};
  contact.plane[0] = a.gap < b.gap ? a : b;
  contact.plane[0].body_velocity = way;
  return contact;
}

// How fast what begins to be clamped goes to the middle between both sides, beside their own way [m/s].
Vec3 to_middle(const ContactPlane& a, const ContactPlane& b, double h, double recovery_speed) {
  const Vec3 out_of_a = (a.normal - b.normal).normalized();
  const double most = std::max(recovery_speed, (a.body_velocity - b.body_velocity).norm());
  const double speed = (b.gap - a.gap) / (2 * h * out_of_a.dot(a.normal));
  return std::clamp(speed, -most, most) * out_of_a;
}

// Where the bodies are nearest to each other beside a particle that they pinch: what lies between them is a
// layer there, and a ball that rolls on it does not climb over each of its particles. Steps from one surface
// to the other and back come nearer to that place by a constant share, so two of them tell where they lead
// [Irons & Tuck 1969]. beside: the touch at the particle itself, which is the answer where no such place is
// found.
Touch nearest_pair(const MovingBody& a, const MovingBody& b, const Vec3& on_a, const Touch& beside,
                   double offsets) {
  const auto step = [&](const Vec3& from) {
    const SurfacePoint to_b = b.near_start(from);
    const Vec3 on_b = from - to_b.distance * to_b.normal;
    const SurfacePoint back = a.near_start(on_b);
    return Vec3(on_b - back.distance * back.normal);
  };
  Vec3 p = on_a;
  for (int round = 0; round < 3; ++round) {
    const Vec3 second = step(p), third = step(second), one = second - p, two = third - second;
    const double share = one.squaredNorm() > 0 ? two.dot(one) / one.squaredNorm() : 0;
    if (!(share >= 0 && share < slowest)) return beside;
    p = second + two / (1 - share);
    const SurfacePoint at_a = a.near_start(p);
    p -= at_a.distance * at_a.normal;
    const SurfacePoint at_b = b.near_start(p);
    if (-at_a.normal.dot(at_b.normal) < opposite) continue;
    const double there = at_b.distance - offsets;
    if (at_b.covered || there > beside.gap) return beside;
    // What the particle does not carry itself is kept from sinking farther, and not lifted.
    const double gap = beside.gap > 0 ? std::max(there, 0.0) : there;
    return {p - 0.5 * at_b.distance * at_b.normal, (at_b.normal - at_a.normal).normalized(), gap};
  }
  return beside;
}

}  // namespace

const Nip* ParticleContacts::nip_of(int particle) const {
  const int k = nip_of_[particle];
  return k < 0 ? nullptr : &nips_[static_cast<std::size_t>(k)];
}

void ParticleContacts::find_nips(const Bodies& bodies, const StepMotion& step) {
  for (const Nip& nip : nips_) nip_of_[nip.particle] = -1;
  nips_.clear();
  const auto reacts = [&bodies](int o) { return bodies[o].reacting() != nullptr; };
  for (const Contact& c : committed_)
    for (int k = 0; k < c.planes && !nip_of(c.particle); ++k) {
      const int first = c.plane[k].obstacle;
      for (int o = 0; o < static_cast<int>(bodies.size()) && !nip_of(c.particle); ++o)
        if (o != first && (reacts(o) || reacts(first))) add_nip(bodies, step, c, first, o);
    }
}

// Adds a nip where the two bodies pinch the particle of the contact.
void ParticleContacts::add_nip(const Bodies& bodies, const StepMotion& step, const Contact& contact,
                               int first, int second) {
  const auto [a, b] = std::minmax(first, second);
  const int particle = contact.particle;
  const Vec3 x = step.place(particle), x_new = x + step.h * step.velocity(particle);
  double reach = 0, offsets = 0;
  for (const int o : {a, b}) {
    const double margin = bodies[o].obstacle().margin, offset = margin + step.radius_of(particle);
    const double near = touching_range(margin) + 2 * bodies[o].travel(x, x_new);
    if (clearance(o, particle) > offset + 2 * near) return;
    reach += 2 * near;
    offsets += offset;
  }
  const SurfacePoint at_a = bodies[a].near_start(x), at_b = bodies[b].near_start(x);
  const double gap = at_a.distance + at_b.distance - offsets;
  if (at_a.covered || at_b.covered || gap > reach || at_a.normal.dot(at_b.normal) > -facing) return;
  clearance(a, particle) = at_a.distance;
  clearance(b, particle) = at_b.distance;
  const Touch beside{x, (at_b.normal - at_a.normal).normalized(), gap};
  const auto roughness = [&bodies](int o) { return bodies[o].obstacle().friction.kinetic; };
  const bool a_holds = roughness(a) != roughness(b) ? roughness(a) > roughness(b) : !bodies[a].reacting();
  const int holder = a_holds ? a : b;
  const bool slides = contact.grip == Grip::slide && contact.plane[0].obstacle == holder;
  nip_of_[particle] = static_cast<int>(nips_.size());
  nips_.push_back(
      {.particle = particle,
       .a = a,
       .b = b,
       .holder = holder,
       .runs = slides && step.foresight == Foresight::ahead,
       .touch = nearest_pair(bodies[a], bodies[b], x - at_a.distance * at_a.normal, beside, offsets)});
}

// With which of two bodies goes what they clamp: the rougher one, of the greater kinetic coefficient. Of two
// that are as rough as each other it is, as long as the clamp lasts, the one that held less than half as much
// of the cloth otherwise when it began: a finger that presses cloth on a table takes it along. -1: neither.
int ParticleContacts::leader_of(const Bodies& bodies, int a, int b, const Contact* before) const {
  const double of_a = bodies[a].obstacle().friction.kinetic, of_b = bodies[b].obstacle().friction.kinetic;
  if (of_a != of_b) return of_a > of_b ? a : b;
  if (before && before->clamped && (before->leader == a || before->leader == b)) return before->leader;
  return 2 * held_by_[a] < held_by_[b] ? a : 2 * held_by_[b] < held_by_[a] ? b : -1;
}

// Makes the contact a clamp where two bodies close on its particle, or have closed on it.
void ParticleContacts::clamp_between(const Bodies& bodies, const StepMotion& step, const Contact* before,
                                     Contact& contact) const {
  const int particle = contact.particle;
  const Vec3 x = step.place(particle);
  const auto offset = [&](int o) { return bodies[o].obstacle().margin + step.radius_of(particle); };
  const auto touch = [&](int o) { return touching_range(bodies[o].obstacle().margin); };
  // How much farther off the body may be than it can come within the step.
  const auto spare = [&](int o) {
    return clearance(o, particle) - offset(o) - touch(o) - bodies[o].travel(x, x);
  };
  const bool clamped = before && before->clamped;
  const int count = static_cast<int>(bodies.size());
  for (int a = 0; a < count; ++a) {
    if (bodies[a].reacting()) continue;
    const double spare_a = spare(a);
    for (int b = a + 1; b < count; ++b) {
      if (bodies[b].reacting() || spare_a + spare(b) > 0) continue;
      const int leader = leader_of(bodies, a, b, before);
      const auto [at_a, at_b, way, closes, holds] =
          squeeze(bodies[a], bodies[b], leader < 0 ? nullptr : &bodies[leader], x);
      if (!holds && !clamped) continue;
      // What began inside one of them comes out first; what began between them, within their margins, is
      // clamped there.
      if (contact.comes_out && std::min(at_a.distance, at_b.distance) < step.radius_of(particle)) continue;
      const double gap_a = at_a.distance - offset(a), gap_b = at_b.distance - offset(b);
      const double least = std::min(touch(a), touch(b));
      if (!no_room(clamped, closes, gap_a, gap_b, least)) continue;
      const ContactPlane of_a{a, at_a.normal, gap_a, bodies[a].velocity(x)};
      const ContactPlane of_b{b, at_b.normal, gap_b, bodies[b].velocity(x)};
      contact = clamp(particle, of_a, of_b, way);
      contact.leader = leader;
      if (!clamped) contact.plane[0].body_velocity += to_middle(of_a, of_b, step.h, recovery_speed_);
      return;
    }
  }
}

// In a fold of the body, such as an armpit, the plane `near` is that of the nearer side alone. Where both
// sides close on the particle, or have closed on it, this makes the contact a clamp: the plane would push the
// particle into the other side, and be the other side's in the next step. Else, in a fold that does not close,
// the plane of the other side is kept as one that was let go, so that it holds the particle where a solve takes
// it there.
void ParticleContacts::look_into_fold(const MovingBody& body, const StepMotion& step,
                                      const ContactPlane& near, const ContactPlane& far,
                                      const Contact* before, Contact& contact) const {
  const double margin = body.obstacle().margin;
  if (near.gap < -margin && (!before || before->comes_out)) return;  // it comes out first
  const Vec3 v_near = near.body_velocity, v_far = far.body_velocity, way = 0.5 * (v_near + v_far);
  const auto with_both = [&](const ContactPlane& plane) {  // its gap at a particle that goes that way
    ContactPlane passed = plane;
    passed.gap += step.h * (way - plane.body_velocity).dot(plane.normal);
    return passed;
  };
  const ContactPlane a = with_both(near), b = with_both(far);
  const bool clamped = before && before->clamped && before->plane[0].obstacle == body.number();
  const bool closes = (v_near - v_far).dot(near.normal - far.normal) > still;
  const bool holds = -near.normal.dot(far.normal) >= std::cos(widest_held);  // both are of one skin
  if ((holds || clamped) && no_room(clamped, closes, a.gap, b.gap, touching_range(margin))) {
    contact = clamp(contact.particle, a, b, way);
    if (!clamped) contact.plane[0].body_velocity += to_middle(a, b, step.h, recovery_speed_);
  } else if (!closes && step.foresight == Foresight::ahead && contact.known < 3) {
    contact.plane[static_cast<std::size_t>(contact.known++)] = far;
  }
}

std::array<double, 3> ParticleContacts::presses(const Contact& contact, const Vec3& r) const {
  std::array<double, 3> lambda = multipliers(contact, r);
  if (const Nip* const nip = nip_of(contact.particle))
    for (int k = 0; k < contact.planes; ++k)
      if (contact.plane[k].obstacle == nip->holder) {
        lambda[k] += nip->impulse;
        break;  // in a fold of the holder, at one of its sides
      }
  return lambda;
}

double ParticleContacts::pressed(const Contact& contact, const Vec3& r) const {
  const std::array<double, 3> presses = this->presses(contact, r);
  double sum = 0;
  for (int k = 0; k < contact.planes; ++k) sum += std::max(presses[k], 0.0);
  return sum;
}

// By Coulomb's law where the slip is too fast to stop within the step, otherwise by a damper that cannot turn
// it round.
void ParticleContacts::rub_in_nips(const Bodies& bodies, const StepMotion& step) {
  for (const Nip& nip : nips_) {
    const double mu = bodies[nip.other()].obstacle().friction.kinetic, most = mu * nip.impulse;
    if (!nip.runs || most == 0) continue;
    double stops = 0;  // m/s: the slip that the bodies' friction on each other could stop
    for (const int o : {nip.a, nip.b})
      if (const ReactingBody* const body = bodies[o].reacting()) stops += mu * body->met_velocity().norm();
    const Vec3 n = nip.touch.normal, v_other = bodies[nip.other()].velocity(step.place(nip.particle));
    const Mat3 along = Mat3::Identity() - n * n.transpose();
    const Vec3 slip = along * (step.velocity(nip.particle) - v_other);
    ContactFriction f{nip.particle, nip.other(), along, v_other, Vec3::Zero(), along, most};
    if (slip.norm() > 2 * stops) {
      const Vec3 t = slip.normalized();
      f.impulse = -most * t;
      f.damping -= t * t.transpose();
    }
    f.damping *= most / std::max({slip.norm(), stops, still}) / step.h;
    friction_.push_back(f);
  }
}

}  // namespace drape
