#include "constraints/contact_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drape {
namespace {

bool before(const CarriedContact& a, const CarriedContact& b) {
  return std::pair(a.particle, a.body) < std::pair(b.particle, b.body);
}

// Whether a body that reacts meets the particle by a carrier.
bool is_carried(const std::vector<CarriedContact>& met, const std::vector<CarriedBody>& bodies, int particle,
                int body) {
  if (met.empty() || !bodies[body].reacts) return false;
  CarriedContact wanted{};
  wanted.particle = particle, wanted.body = body;
  const auto place = std::lower_bound(met.begin(), met.end(), wanted, before);
  return place != met.end() && !before(wanted, *place) && !place->impulse.isZero(0);
}

// Adds the contact to those that are sorted by particle and body; of the same two, the impulse stays.
void note(CarriedContact contact, std::vector<CarriedContact>& met) {
  const auto place = std::lower_bound(met.begin(), met.end(), contact, before);
  if (place == met.end() || before(contact, *place)) {
    met.insert(place, contact);
    return;
  }
  contact.impulse = place->impulse;
  *place = contact;
}

}  // namespace

void ContactStep::filter(const VecX& v, Filter& filter) const {
  filter.clear();
  constraints_->pins_.filter(constraints_->step_, v, filter);
  constraints_->contacts_.filter(constraints_->step_, v, filter);
}

const std::vector<ContactFriction>& ContactStep::friction() {
  return constraints_->contacts_.make_friction(constraints_->bodies_, constraints_->step_);
}

const VecX& ContactStep::correction() const { return constraints_->contacts_.correction(); }
const std::vector<Contact>& ContactStep::touching() const { return constraints_->contacts_.touching(); }
const std::vector<FaceContact>& ContactStep::touching_faces() const {
  return constraints_->faces_.touching();
}

void ContactStep::clear_impulses() {
  constraints_->step_.work = 0;
  for (MovingBody& body : constraints_->bodies_) body.clear_impulse();
}

// Gives the body the reaction to its impulse on a particle, which ends the step with v and is pushed at
// body_velocity.
void ContactStep::push(int body, int particle, const Vec3& v, const Vec3& body_velocity,
                       const Vec3& impulse) {
  const StepMotion& step = constraints_->step_;
  constraints_->step_.work += body_velocity.dot(impulse);
  constraints_->bodies_[body].push(-impulse, step.place(particle) + step.h * v,
                                   (body_velocity - step.velocity(particle)).norm());
}

void ContactStep::receive(const VecX& v, const VecX& r, const VecX& x_end) {
  clear_impulses();
  constraints_->step_.work += constraints_->self_.push_bodies(constraints_->bodies_, x_end);
  for (const Contact& c : touching()) {
    if (!c.active()) continue;
    Vec3 rest = r.segment<3>(3 * c.particle);
    const std::array<double, 3> lambda = multipliers(c, rest);
    for (int k = 1; k < c.planes; ++k) {  // where several bodies touch, each gets the part of its plane
      const ContactPlane& p = c.plane[k];
      const Vec3 part = lambda[k] * p.normal;
      push(p.obstacle, c.particle, v.segment<3>(3 * c.particle), p.body_velocity, part);
      rest -= part;
    }
    push(c.plane[0].obstacle, c.particle, v.segment<3>(3 * c.particle), c.body_velocity(), rest);
  }
  for (const ContactFriction& f : constraints_->contacts_.friction()) {
    const Vec3 slip = v.segment<3>(3 * f.particle) - f.body_velocity;
    push(f.body, f.particle, v.segment<3>(3 * f.particle), f.body_velocity,
         f.impulse - constraints_->step_.h * (f.damping * slip));
  }
  receive_faces(v);
  for (const MovingPin& pin : moving_pins()) receive_pin(pin, r.segment<3>(3 * pin.particle));
}

void ContactStep::receive_pin(const MovingPin& pin, const Vec3& impulse) {
  const StepMotion& step = constraints_->step_;
  const Vec3 velocity = constraints_->pins_.velocity(pin.particle);
  constraints_->step_.work += velocity.dot(impulse);
  if (pin.body < 0) return;
  // A pin pulls at a body that it has not run into: the body may become as fast as the pull itself makes it.
  MovingBody& body = constraints_->bodies_[pin.body];
  const double by_pull = body.reacting() ? impulse.norm() / body.obstacle().rigid->mass : 0;
  const double approach = (velocity - step.velocity(pin.particle)).norm();
  body.push(-impulse, step.place(pin.particle) + step.h * velocity, std::max(approach, by_pull));
}

void ContactStep::receive_faces(const VecX& v) {
  FaceContacts& faces = constraints_->faces_;
  if (faces.touching().empty()) return;
  const StepMotion& step = constraints_->step_;
  VecX& x_new = constraints_->x_new_;
  x_new = step.x + step.h * v + correction();
  faces.take_impulse(step.h, x_new, v);
  for (const FaceContact& c : faces.touching()) {
    constraints_->step_.work += c.body_velocity.dot(c.impulse);
    constraints_->bodies_[c.body].push(-c.impulse, c.at(x_new), (c.at(step.v) - c.body_velocity).norm());
  }
}

ContactImbalance ContactStep::imbalance(const VecX& v, const VecX& r, const VecX& x_new) {
  const StepMotion& step = constraints_->step_;
  ContactImbalance found;
  if (step.foresight == Foresight::ahead) found.wrong = constraints_->self_.imbalance(step.h, x_new);
  if (!bodies()) return found;
  ParticleContacts& contacts = constraints_->contacts_;
  contacts.look_on_path(constraints_->bodies_, step, x_new);
  found.wrong = std::hypot(found.wrong, contacts.imbalance(constraints_->bodies_, step, v, r, x_new));
  if (step.foresight == Foresight::ahead)
    found.wrong = std::hypot(found.wrong, constraints_->faces_.imbalance(step.h, x_new));
  for (const Contact& c : touching())
    if (c.active()) found.borne += r.segment<3>(3 * c.particle).squaredNorm();
  found.borne = std::sqrt(found.borne);
  return found;
}

ContactChange ContactStep::react(const VecX& v, const VecX& r, const VecX& x_new, double noise,
                                 double curvature) {
  const StepMotion& step = constraints_->step_;
  ParticleContacts& contacts = constraints_->contacts_;
  ContactChange change;
  if (step.foresight == Foresight::ahead) change.faces = constraints_->self_.react(v, r, x_new, curvature);
  if (!bodies()) return change;
  change.grip = contacts.react(constraints_->bodies_, step, v, r, x_new, noise);
  change.caught = contacts.catch_on_path(constraints_->bodies_, step, r, x_new);
  if (step.foresight == Foresight::ahead) change.faces = constraints_->faces_.react(x_new, v) || change.faces;
  return change;
}

bool ContactStep::move_bodies(double noise) {
  std::vector<MovingBody>& bodies = constraints_->bodies_;
  constraints_->meeting_.solve(bodies);
  bool moved = false;
  for (MovingBody& body : bodies)
    if (body.correct(noise)) moved = true;
  if (!moved) return false;
  constraints_->contacts_.follow(bodies, constraints_->step_);
  constraints_->faces_.follow(bodies);
  constraints_->self_.follow(bodies);
  constraints_->pins_.move(bodies, constraints_->step_);
  return true;
}

bool ContactStep::bodies_agree(double share) const {
  return std::all_of(
      constraints_->bodies_.begin(), constraints_->bodies_.end(),
      [share](const MovingBody& body) { return !body.reacting() || body.reacting()->converged(share); });
}

// The bodies as carriers see them: without what these gave them in the last response, which may be that of the step before.
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
               .velocity = body->free_velocity() + body->met_velocity() - given[b].first / body->mass(),
               .spin = body->free_spin() + body->met_spin() - inverse_inertia * given[b].second,
               .velocity_before = body->velocity(),
               .spin_before = body->spin(),
               .inverse_mass = 1 / body->mass(),
               .inverse_inertia = inverse_inertia};
  }
}

// Lets carriers take what their particles meet, and then the particles what is left.
void ContactStep::carry(ContactMode mode, const VecX& x, const VecX& v,
                        const std::vector<Carriers*>& carriers, VecX& x_new, VecX& v_new) {
  if (carriers.empty()) return;
  StepMotion& step = constraints_->step_;
  ParticleContacts& contacts = constraints_->contacts_;
  std::vector<CarriedContact>& met = constraints_->carried_;
  see_bodies();
  // What was met in an earlier round stays known, also where a body that reacts now gives way faster than the particle comes:
  // the impact has made it do so.
  for (CarriedContact& c : met)
    c.body_velocity = constraints_->bodies_[c.body].velocity(step.place(c.particle));
  contacts.each_response([&](const ContactResponse& r) {
    const Obstacle& obstacle = constraints_->bodies_[r.body].obstacle();
    note({r.particle, r.body, r.normal, r.gap, r.body_velocity, obstacle.friction, obstacle.restitution},
         met);
  });
  if (met.empty()) return;
  constraints_->carried_x_ = x;
  constraints_->carried_v_ = v;
  constraints_->carried_before_ = step.v;
  const CarriedMotion motion{mode,
                             step.h,
                             contacts.recovery_speed(),
                             step.held,
                             step.x,
                             constraints_->carried_bodies_,
                             constraints_->carried_before_,
                             constraints_->carried_x_,
                             constraints_->carried_v_};
  bool any = false;
  for (Carriers* const one : carriers) any = one->carry(met, motion) || any;
  if (!any) return;
  step.v.swap(constraints_->carried_before_);
  contacts.respond_again(mode, constraints_->bodies_, step, constraints_->carried_x_,
                         constraints_->carried_v_, x_new, v_new);
  step.v.swap(constraints_->carried_before_);
  // Where a body reacts, the carriers know better than the plane how it moves with what they push it by.
  for (const CarriedContact& c : met) {
    if (!constraints_->carried_bodies_[c.body].reacts || c.impulse.isZero(0)) continue;
    x_new.segment<3>(3 * c.particle) = constraints_->carried_x_.segment<3>(3 * c.particle);
    v_new.segment<3>(3 * c.particle) = constraints_->carried_v_.segment<3>(3 * c.particle);
  }
}

// Gives the bodies what carriers took of them; v: without bodies.
void ContactStep::push_carried(const VecX& v, const VecX& x_new) {
  const StepMotion& step = constraints_->step_;
  for (auto& [impulse, moment] : constraints_->carried_by_) {
    impulse.setZero();
    moment.setZero();
  }
  for (const CarriedContact& c : constraints_->carried_) {
    if (c.impulse.isZero(0)) continue;
    const Vec3 place = x_new.segment<3>(3 * c.particle);
    const CarriedBody& body = constraints_->carried_bodies_[c.body];
    auto& [impulse, moment] = constraints_->carried_by_[c.body];
    impulse -= c.impulse;
    moment -= (place - (body.centre + step.h * body.velocity)).cross(c.impulse);
    constraints_->step_.work += c.body_velocity.dot(c.impulse);
    constraints_->bodies_[c.body].push(-c.impulse, place,
                                       (c.body_velocity - Vec3(v.segment<3>(3 * c.particle))).norm());
  }
}

void ContactStep::respond(ContactMode mode, const VecX& x, const VecX& v, const VecX& pulled,
                          const std::vector<Carriers*>& carriers, VecX& x_new, VecX& v_new, double noise) {
  const StepMotion& step = constraints_->step_;
  const PinSet& pins = constraints_->pins_;
  for (MovingBody& body : constraints_->bodies_) body.begin_corrections();
  constraints_->carried_.clear();
  bool moved = false;
  for (bool again = true; again; moved = moved || again) {
    constraints_->contacts_.respond(mode, constraints_->bodies_, step, x, v, x_new, v_new);
    carry(mode, x, v, carriers, x_new, v_new);
    clear_impulses();
    push_carried(v, x_new);
    constraints_->contacts_.each_response([&](const ContactResponse& r) {
      if (is_carried(constraints_->carried_, constraints_->carried_bodies_, r.particle, r.body)) return;
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

double ContactStep::mobility_of(const MovingPin& pin) const {
  if (pin.body < 0) return 0;
  const ReactingBody* body = constraints_->bodies_[pin.body].reacting();
  if (!body) return 0;
  const Mat3 mobility = body->mobility(constraints_->step_.place(pin.particle));
  return mobility.trace() - 2 / body->mass();
}

void ContactStep::count_face_impulse(double duration, const VecX& x, const VecX& v) {
  constraints_->faces_.count_impulse(duration, x, v);
}

void ContactStep::settle_faces(const VecX& x_new, const VecX& v_new) {
  constraints_->faces_.react(x_new, v_new);
}

ContactReport ContactStep::finish(VecX& x_new, VecX& v_new) {
  ContactReport report;
  if (!meets_anything()) return report;
  StepMotion& step = constraints_->step_;
  if (bodies()) constraints_->contacts_.guard(constraints_->bodies_, step, x_new, v_new, report);
  report.self_guarded = constraints_->self_.guard(constraints_->bodies_, constraints_->contacts_.touching(),
                                                  true, x_new, v_new);
  if (bodies() && (report.self_guarded > 0 || constraints_->self_.crossing())) {
    const int before = report.guarded;
    constraints_->contacts_.guard(constraints_->bodies_, step, x_new, v_new, report);
    if (report.guarded > before)  // a common way led into a body
      report.self_guarded += constraints_->self_.guard(
          constraints_->bodies_, constraints_->contacts_.touching(), false, x_new, v_new);
  }
  constraints_->self_.end_step(x_new);
  report.self_contacts = constraints_->self_.pushing();
  report.tangled = constraints_->self_.tangled();
  report.pinched = constraints_->self_.pinched();
  if (bodies()) {
    if (report.self_guarded > 0 || report.tangled > 0)
      constraints_->contacts_.look_again();  // these went otherwise than bodies were told
    constraints_->contacts_.commit();
    constraints_->faces_.end_step(constraints_->bodies_, step.x, x_new);
    const BodyMeetingReport met = constraints_->meeting_.end_step(constraints_->bodies_);
    report.converged = report.converged && met.settled;
    report.body_contacts = met.touches;
    report.body_overlap = met.deepest;
    for (MovingBody& body : constraints_->bodies_)
      if (!body.end_step()) report.converged = false;
  }
  step.last_h = step.h;
  step.x_end = x_new;
  report.contacts = static_cast<int>(constraints_->contacts().size());
  return report;
}

}  // namespace drape
