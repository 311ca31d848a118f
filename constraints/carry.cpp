// The response of bodies to a free motion, and what carriers (constraints/carriers.h) take of it.
#include <algorithm>
#include <utility>

#include "constraints/contact_step.h"

namespace drape {
namespace {

// At most this many times the carriers are asked again because their motion met bodies that react at new
// places.
constexpr int most_rounds = 8;

bool before(const CarriedContact& a, const CarriedContact& b) {
  return std::pair(a.particle, a.body) < std::pair(b.particle, b.body);
}

// Whether a carrier has what the particle meets of a body that reacts. It then moves as its carriers say, and
// no body gets an impulse of what it would have met by itself.
bool is_carried(const std::vector<CarriedContact>& met, const std::vector<CarriedBody>& bodies,
                int particle) {
  const auto first = std::lower_bound(met.begin(), met.end(), particle,
                                      [](const CarriedContact& c, int i) { return c.particle < i; });
  for (auto c = first; c != met.end() && c->particle == particle; ++c)
    if (bodies[c->body].reacts && c->taken) return true;
  return false;
}

// Adds the contact to those that are sorted by particle and body, or takes the place of the one of the same
// two.
void note(const CarriedContact& contact, std::vector<CarriedContact>& met) {
  const auto place = std::lower_bound(met.begin(), met.end(), contact, before);
  if (place == met.end() || before(contact, *place))
    met.insert(place, contact);
  else
    *place = contact;
}

CarriedContact contact_of(const ContactResponse& r, const std::vector<MovingBody>& bodies) {
  const Obstacle& obstacle = bodies[r.body].obstacle();
  return {r.particle, r.body, r.normal, r.gap, r.body_velocity, obstacle.friction, obstacle.restitution};
}

// Adds what the motion that carriers have made meets of bodies that react, where it is not known yet; true
// when there is any.
bool note_more(const ParticleContacts& contacts, const std::vector<MovingBody>& bodies,
               const Carriers& carriers, std::vector<CarriedContact>& met) {
  bool any = false;
  contacts.each_response([&](const ContactResponse& r) {
    if (!bodies[r.body].reacting() || !carriers.carries(r.particle)) return;
    const CarriedContact contact = contact_of(r, bodies);
    const auto place = std::lower_bound(met.begin(), met.end(), contact, before);
    if (place != met.end() && !before(contact, *place)) return;
    met.insert(place, contact);
    any = true;
  });
  return any;
}

}  // namespace

// The bodies as carriers see them: without what these gave them in the last response, or are expected to give
// them before the first one, and without what they do to each other, which the carriers find together with
// their own impulses.
void ContactStep::see_bodies() {
  const std::vector<MovingBody>& bodies = constraints_->bodies_;
  std::vector<CarriedBody>& seen = constraints_->carried_bodies_;
  auto& given = constraints_->carried_by_;
  seen.resize(bodies.size());
  given.resize(bodies.size(), {Vec3::Zero(), Vec3::Zero()});
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ReactingBody* const body = bodies[b].reacting();
    seen[b] = {};
    if (!body) continue;
    const Mat3 inverse_inertia = body->inverse_inertia();
    seen[b] = {.reacts = true,
               .centre = body->centre(),
               .velocity = body->free_velocity() - given[b].first / body->mass(),
               .spin = body->free_spin() - inverse_inertia * given[b].second,
               .velocity_before = body->velocity(),
               .spin_before = body->spin(),
               .inverse_mass = 1 / body->mass(),
               .inverse_inertia = inverse_inertia};
  }
  constraints_->meeting_.show(constraints_->carried_touches_);
}

// Lets carriers take what their particles meet, and then the particles what is left.
void ContactStep::carry(ContactMode mode, const VecX& x, const VecX& v, Carriers& carriers, VecX& x_new,
                        VecX& v_new) {
  StepMotion& step = constraints_->step_;
  ParticleContacts& contacts = constraints_->contacts_;
  std::vector<CarriedContact>& met = constraints_->carried_;
  see_bodies();
  // What was met in an earlier round stays known, also where a body that reacts now gives way faster than the
  // particle comes: the impact has made it do so.
  for (CarriedContact& c : met)
    c.body_velocity = constraints_->bodies_[c.body].velocity(step.place(c.particle));
  contacts.each_response([&](const ContactResponse& r) { note(contact_of(r, constraints_->bodies_), met); });
  const CarriedMotion motion{mode,
                             step.h,
                             contacts.recovery_speed(),
                             step.held,
                             step.masses,
                             step.x,
                             constraints_->carried_bodies_,
                             constraints_->carried_touches_,
                             constraints_->carried_before_,
                             constraints_->carried_x_,
                             constraints_->carried_v_};
  bool more = true;
  for (int round = 0; more && round < most_rounds; ++round) {
    constraints_->carried_x_ = x;
    constraints_->carried_v_ = v;
    constraints_->carried_before_ = step.v;
    if (!carriers.carry(met, constraints_->self_.touching(), motion)) return;
    if (!bodies()) {
      x_new = constraints_->carried_x_;
      v_new = constraints_->carried_v_;
      return;
    }
    step.v.swap(constraints_->carried_before_);
    contacts.respond_again(mode, constraints_->bodies_, step, constraints_->carried_x_,
                           constraints_->carried_v_, x_new, v_new);
    step.v.swap(constraints_->carried_before_);
    more = note_more(contacts, constraints_->bodies_, carriers, met);
  }
  // Where a body reacts, the carriers know better than the plane how it moves with what they push it by.
  for (const CarriedContact& c : met) {
    if (!constraints_->carried_bodies_[c.body].reacts || !c.taken) continue;
    x_new.segment<3>(3 * c.particle) = constraints_->carried_x_.segment<3>(3 * c.particle);
    v_new.segment<3>(3 * c.particle) = constraints_->carried_v_.segment<3>(3 * c.particle);
  }
}

// Gives the bodies what carriers took of them; v: without bodies.
void ContactStep::push_carried(const VecX& v, const VecX& x_new) {
  const StepMotion& step = constraints_->step_;
  for (const CarriedContact& c : constraints_->carried_) {
    if (c.impulse.isZero(0)) continue;
    const Vec3 place = x_new.segment<3>(3 * c.particle);
    const CarriedBody& body = constraints_->carried_bodies_[c.body];
    auto& [impulse, moment] = constraints_->carried_by_[c.body];
    impulse -= c.impulse;
    moment -= (place - (body.centre + step.h * body.velocity)).cross(c.impulse);
    constraints_->step_.work += c.body_velocity.dot(c.impulse);
    constraints_->bodies_[c.body].pull(-c.impulse, place,
                                       (c.body_velocity - Vec3(v.segment<3>(3 * c.particle))).norm());
  }
}

void ContactStep::respond(ContactMode mode, const VecX& x, const VecX& v, const VecX& pulled,
                          Carriers* carriers, VecX& x_new, VecX& v_new, double noise) {
  const StepMotion& step = constraints_->step_;
  const PinSet& pins = constraints_->pins_;
  for (MovingBody& body : constraints_->bodies_) body.begin_corrections();
  constraints_->carried_.clear();
  bool moved = false;
  x_new = x;
  v_new = v;
  for (bool again = true; again; moved = moved || again) {
    if (bodies()) constraints_->contacts_.respond(mode, constraints_->bodies_, step, x, v, x_new, v_new);
    if (carriers) carry(mode, x, v, *carriers, x_new, v_new);
    clear_impulses();
    push_carried(v, x_new);
    constraints_->contacts_.each_response([&](const ContactResponse& r) {
      if (is_carried(constraints_->carried_, constraints_->carried_bodies_, r.particle)) return;
      constraints_->step_.work += r.body_velocity.dot(r.impulse);
      constraints_->bodies_[r.body].push(-r.impulse, r.place, r.approach);
    });
    receive_faces(v_new);
    for (const MovingPin& pin : moving_pins()) {
      const Vec3 brought = pins.velocity(pin.particle) - step.velocity(pin.particle);
      receive_pin(pin, pulled.segment<3>(3 * pin.particle) + step.mass(pin.particle) * brought);
    }
    again = move_bodies(noise);
  }
  if (!moved) return;
  for (const MovingPin& pin : moving_pins()) {  // the body that carries them has changed its motion
    const Vec3 velocity = pins.velocity(pin.particle);
    x_new.segment<3>(3 * pin.particle) = step.place(pin.particle) + step.h * velocity;
    v_new.segment<3>(3 * pin.particle) = velocity;
  }
}

}  // namespace drape
