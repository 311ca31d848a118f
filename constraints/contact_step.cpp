#include "constraints/contact_step.h"

#include <algorithm>
#include <cmath>

namespace drape {

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
  for (auto& [impulse, moment] : constraints_->carried_by_) {
    impulse.setZero();
    moment.setZero();
  }
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
  constraints_->bodies_[pin.body].pull(-impulse, step.place(pin.particle) + step.h * velocity,
                                       (velocity - step.velocity(pin.particle)).norm());
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
    found.wrong = std::hypot(found.wrong, constraints_->faces_.imbalance(step, x_new, v));
  for (const Contact& c : touching())
    if (c.active() && !c.clamped) found.borne += r.segment<3>(3 * c.particle).squaredNorm();
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
  if (step.foresight == Foresight::ahead) {
    const FaceContacts::Change faces = constraints_->faces_.react(step, x_new, v);
    change.faces = change.faces || faces.acts;
    change.rubs = faces.rubs;
  }
  return change;
}

bool ContactStep::move_bodies(double noise) {
  std::vector<MovingBody>& bodies = constraints_->bodies_;
  constraints_->meeting_.solve(bodies, constraints_->contacts_.nips());
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
  constraints_->faces_.react(constraints_->step_, x_new, v_new);
}

ContactReport ContactStep::finish(VecX& x_new, VecX& v_new) {
  ContactReport report;
  if (!meets_anything()) return report;
  StepMotion& step = constraints_->step_;
  if (bodies()) constraints_->contacts_.guard(constraints_->bodies_, step, x_new, v_new, report);
  const auto guard_cloth = [&](bool in_common) {
    const GuardReport of_cloth = constraints_->self_.guard(
        constraints_->bodies_, constraints_->contacts_.touching(), in_common, x_new, v_new);
    report.self_guarded += of_cloth.guarded;
    report.self_held += of_cloth.held;
    report.stood_still = std::max(report.stood_still, of_cloth.stood_still);
  };
  guard_cloth(true);
  if (bodies() && (report.self_guarded > 0 || constraints_->self_.crossing())) {
    const int before = report.guarded;
    constraints_->contacts_.guard(constraints_->bodies_, step, x_new, v_new, report);
    if (report.guarded > before) guard_cloth(false);  // a common way led into a body
  }
  constraints_->self_.end_step(x_new);
  report.self_contacts = constraints_->self_.pushing();
  report.tangled = constraints_->self_.tangled();
  report.pinched = constraints_->self_.pinched();
  for (const Contact& c : touching())
    if (c.clamped && !constraints_->self_.is_pinched(c.particle)) ++report.pinched;
  if (bodies()) {
    if (report.self_guarded > 0 || report.tangled > 0)
      constraints_->contacts_.look_again();  // these went otherwise than bodies were told
    constraints_->contacts_.commit();
    constraints_->faces_.end_step(constraints_->bodies_, step.x, x_new, v_new);
    const BodyMeetingReport met =
        constraints_->meeting_.end_step(constraints_->bodies_, constraints_->contacts_.nips());
    report.converged = report.converged && met.settled;
    report.body_contacts = met.touches;
    report.body_overlap = met.deepest;
    for (MovingBody& body : constraints_->bodies_)
      if (!body.end_step()) report.converged = false;
  }
  constraints_->last_carried_by_ = constraints_->carried_by_;
  step.last_h = step.h;
  step.x_end = x_new;
  report.contacts = static_cast<int>(constraints_->contacts().size());
  return report;
}

}  // namespace drape
