// How contacts hold: which of them stick, slide or are let go, and what filter and friction a solve gets from
// them.
#include <algorithm>

#include "constraints/particle_contacts.h"

namespace drape {
namespace {

// A contact changes its grip this often within a step at most; then it keeps its grip until the next step.
constexpr int most_changes = 3;
// A particle counts as stopped where friction could stop its sliding a million times over within the step.
constexpr double stop_fraction = 1e-6;
// Where friction came out more than this many times mu N, the damper is made anew.
constexpr double overrubbed = 1.05;

Vec3 tangential(const Contact& contact, const Vec3& v) {
  const Mat3 Q = contact.locked_directions();
  return v - Q * (Q.transpose() * v);
}

const Friction& friction_of(const ParticleContacts::Bodies& bodies, const Contact& contact) {
  return bodies[contact.plane[0].obstacle].obstacle().friction;
}

// The speeds along the normals that the planes prescribe for the end of the step [m/s].
std::array<double, 3> normal_speeds(const Contact& contact, double h) {
  std::array<double, 3> speeds = {};
  for (int k = 0; k < contact.planes; ++k) {
    const ContactPlane& p = contact.plane[k];
    speeds[k] = p.body_velocity.dot(p.normal) - std::max(p.gap, 0.0) / h;
  }
  return speeds;
}

// The impulse that stops the approach to the planes, whatever else pushes [N s].
double arrival_impulse(const Contact& contact, const StepMotion& step) {
  std::array<double, 3> change = normal_speeds(contact, step.h);
  for (int k = 0; k < contact.planes; ++k)
    change[k] -= step.velocity(contact.particle).dot(contact.plane[k].normal);
  const std::array<double, 3> pushes =
      multipliers(contact, step.mass(contact.particle) * along_planes(contact, change));
  double sum = 0;
  for (int k = 0; k < contact.planes; ++k) sum += std::max(pushes[k], 0.0);
  return sum;
}

}  // namespace

void ParticleContacts::start_grip(const Bodies& bodies, const StepMotion& step, Contact& contact,
                                  const Contact* before) const {
  const Friction& mu = friction_of(bodies, contact);
  contact.last_slip = tangential(contact, step.velocity(contact.particle) - contact.body_velocity());
  contact.slip = contact.last_slip;
  contact.grip = before ? before->grip : mu.statics == 0 ? Grip::slide : Grip::stick;
  contact.arrival_impulse = arrival_impulse(contact, step);
  if (!before) return;
  const double steady =
      std::max(0.0, before->normal_impulse - before->arrival_impulse) * step.h / step.last_h;
  contact.normal_impulse = steady + contact.arrival_impulse;
  if (before->grip != Grip::slide) return;
  const double arrived =
      (before->arrival_impulse - contact.arrival_impulse) * mu.kinetic / step.mass(contact.particle);
  const Vec3 expected =
      2 * contact.slip - before->last_slip + arrived / std::max(contact.slip.norm(), 1e-12) * contact.slip;
  if (expected.dot(contact.slip) > stop_fraction * contact.slip.squaredNorm()) contact.slip = expected;
}

void ParticleContacts::filter(const StepMotion& step, const VecX& v, Filter& filter) const {
  for (const Contact& c : trial_) {
    if (!c.active()) continue;
    const Vec3 normal_part = along_planes(c, normal_speeds(c, step.h));
    const Mat3 Q = c.locked_directions();
    const Mat3 S = Mat3::Identity() - Q * Q.transpose();
    const Vec3 now = v.segment<3>(3 * c.particle);
    if (c.grip == Grip::stick)
      filter.constrain(c.particle, Mat3::Zero(), normal_part + S * c.body_velocity() - now);
    else
      filter.constrain(c.particle, S, normal_part - (now - S * now));
  }
}

const std::vector<ContactFriction>& ParticleContacts::make_friction(const Bodies& bodies,
                                                                    const StepMotion& step) {
  friction_.clear();
  for (const Contact& c : trial_) {
    if (!c.active() || c.grip == Grip::stick) continue;
    const double mu = friction_of(bodies, c).kinetic;
    if (mu == 0) continue;
    ContactFriction f{c.particle, c.plane[0].obstacle, Mat3::Zero(), c.body_velocity(), Vec3::Zero()};
    if (c.grip == Grip::breaking_loose) {
      f.impulse = c.friction_impulse;
    } else {
      const Mat3 Q = c.locked_directions();
      const double coefficient = mu * c.normal_impulse / (step.h * std::max(c.slip.norm(), 1e-12));
      f.damping = coefficient * (Mat3::Identity() - Q * Q.transpose());
    }
    friction_.push_back(f);
  }
  return friction_;
}

bool ParticleContacts::react(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r,
                             double noise) {
  bool changed = false;
  for (Contact& c : trial_) {
    if (!c.active()) continue;
    if (update_grip(bodies, step, c, v, r.segment<3>(3 * c.particle), noise)) changed = true;
  }
  return changed;
}

bool ParticleContacts::update_grip(const Bodies& bodies, const StepMotion& step, Contact& c, const VecX& v,
                                   const Vec3& r, double noise) const {
  const std::array<double, 3> lambda = multipliers(c, r);
  const auto weakest =
      static_cast<std::size_t>(std::min_element(lambda.begin(), lambda.begin() + c.planes) - lambda.begin());
  if (lambda[weakest] < -noise) {  // it would pull the particle towards the body, so it is let go
    for (auto k = static_cast<int>(weakest); k + 1 < c.planes; ++k) c.plane[k] = c.plane[k + 1];
    --c.planes;
    c.arrival_impulse = arrival_impulse(c, step);
    if (!c.active()) return true;
    // The particle slides along the planes that still hold, in more directions than before.
    c.last_slip = tangential(c, step.velocity(c.particle) - c.body_velocity());
    c.slip = c.last_slip;
    return true;
  }
  const Friction& mu = friction_of(bodies, c);
  const int before = committed_of_[c.particle];
  const bool slid = before >= 0 && committed_[before].grip == Grip::slide;  // when the step began
  double normal = 0;
  for (int k = 0; k < c.planes; ++k) normal += std::max(lambda[k], 0.0);
  const double rubbed = mu.kinetic * c.normal_impulse;
  c.normal_impulse = normal;
  if (c.changes >= most_changes) return false;

  const Vec3 rub = tangential(c, r);
  const Vec3 slip = tangential(c, v.segment<3>(3 * c.particle) - c.body_velocity());
  Grip next = c.grip;
  switch (c.grip) {
    case Grip::stick:
      if (slid && rub.norm() > mu.kinetic * normal + noise) {  // friction does not stop it in this step
        next = Grip::slide;
        c.changes = most_changes - 1;
      } else if (!slid && rub.norm() > mu.statics * normal + noise) {
        next = Grip::breaking_loose;
        c.friction_impulse = mu.kinetic * normal * rub.normalized();
      }
      break;
    case Grip::breaking_loose:
      if (slip.dot(c.friction_impulse) > 0) next = Grip::stick;  // otherwise friction would drive the motion
      break;
    case Grip::slide:
      if (step.mass(c.particle) * slip.norm() < stop_fraction * mu.kinetic * normal)
        next = Grip::stick;
      else if (slip.norm() * rubbed > overrubbed * mu.kinetic * normal * c.slip.norm()) {
        c.slip = slip;  // it slides faster than expected: the damper rubbed with more than mu N
        ++c.changes;
        return true;
      }
      break;
  }
  if (next == c.grip) return false;
  c.grip = next;
  ++c.changes;
  return true;
}

}  // namespace drape
