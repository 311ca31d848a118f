// How contacts hold: which of them stick, slide or are let go, and what filter and friction a solve gets from
// them.
#include <algorithm>
#include <cmath>

#include "constraints/inertia.h"
#include "constraints/particle_contacts.h"

namespace drape {
namespace {

// A contact in doubt follows what solves ask for by this share at least.
constexpr double least_relaxed = 0.5;
// A contact that stops and comes loose this often within a step is braked from then on.
constexpr int most_changes = 3;
// A contact that is braked because it came loose too often is linearised anew once friction is within this
// share of mu N: Newton's method then ends what the damper comes near to by a part of the error in each
// round.
constexpr double nearly = 0.25;
// A damper may rub with this many times mu N where contact is not part of the solve.
constexpr double overrubbed = 1.05;
// A contact that slides sticks only where the friction asked for is below mu N by more than this share: when
// a contact comes loose, both are equal but for rounding.
constexpr double round_off = 1e-9;
// A particle counts as stopped where its momentum is at most this share of what friction can take within the
// step.
constexpr double stop_fraction = 1e-5;

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

// The impulse that stops the approach to the planes of a particle that moves with v, whatever else pushes [N
// s].
double arrival_impulse(const Contact& contact, const StepMotion& step, const Vec3& v) {
  std::array<double, 3> change = normal_speeds(contact, step.h);
  for (int k = 0; k < contact.planes; ++k) change[k] -= v.dot(contact.plane[k].normal);
  const std::array<double, 3> pushes =
      multipliers(contact, step.mass(contact.particle) * along_planes(contact, change));
  double sum = 0;
  for (int k = 0; k < contact.planes; ++k) sum += std::max(pushes[k], 0.0);
  return sum;
}

double arrival_impulse(const Contact& contact, const StepMotion& step) {
  return arrival_impulse(contact, step, step.velocity(contact.particle));
}

// The impulse that keeps a particle that moves with v from passing through a plane [N s].
double passing_impulse(const StepMotion& step, const Contact& contact, int plane, const Vec3& v) {
  const ContactPlane& p = contact.plane[plane];
  const double apart = (v - p.body_velocity).dot(p.normal) + std::max(p.gap, 0.0) / step.h;
  return step.mass(contact.particle) * std::max(-apart, 0.0);
}

// The impulse of friction for a slip of 1 m/s [N s / (m/s)]. A slip at which the particle counts as stopped
// is not told from a smaller one.
double rubbing(const Contact& contact, double mu, double mass) {
  const double most = mu * contact.normal_impulse;
  return most > 0 ? most / std::max(contact.slip.norm(), stop_fraction * most / mass) : 0;
}

// Takes Coulomb's law at this slip.
void slide_at(Contact& contact, double mu, const Vec3& slip) {
  contact.grip = Grip::slide;
  contact.slip = slip;
  contact.friction_impulse = -mu * contact.normal_impulse * slip.stableNormalized();
}

// What friction did to the particle in a solve, with the slip and the reaction r that came out [N s].
Vec3 given_friction(const Contact& contact, double mu, double mass, const Vec3& slip, const Vec3& r) {
  if (contact.grip == Grip::stick) return tangential(contact, r);
  if (contact.grip == Grip::brake) return -rubbing(contact, mu, mass) * slip;
  const Vec3 t = contact.friction_impulse.stableNormalized();
  return contact.friction_impulse - rubbing(contact, mu, mass) * (slip - t.dot(slip) * t);
}

// By which share the normal impulse of a contact in doubt follows what a solve asks it to change by. Two
// solves tell how what is asked for depends on what was taken; the share is what this line asks for.
//                                                                        [Aitken's method; Irons & Tuck 1969]
double relaxation(const Contact& contact, double change) {
  const double fell = contact.last_change - change;
  if (fell * contact.last_change <= 0) return least_relaxed;
  return std::clamp(contact.relaxed * contact.last_change / fell, least_relaxed, 1.0);
}

// Whether a contact that is braked for good is so near to its law that it slides instead. It may stop and
// come loose a few times more, and then stays braked.
bool may_slide_again(const Contact& contact, const Vec3& slip, const Vec3& given, double most) {
  return contact.changes <= 2 * most_changes && slip.dot(contact.slip) > 0 &&
         std::abs(given.norm() - most) < nearly * most;
}

// What is wrong with friction where contact is not part of the solve [N s]. What slid all along is braked,
// and the damper may rub with less than mu N; what has come loose goes on sliding. The answer then changes
// smoothly with the motion of a body that reacts.
double wrong_apart(const Contact& contact, const Vec3& given, double most) {
  if (contact.grip == Grip::slide) return std::abs(contact.friction_impulse.norm() - most);
  return given.norm() > overrubbed * most ? given.norm() - most : 0;
}

}  // namespace

// The coefficient up to which a contact sticks: what slid when the step began is stopped by kinetic friction.
double ParticleContacts::sticking(const Contact& contact, const Friction& mu) const {
  const int before = committed_of_[contact.particle];
  return before >= 0 && committed_[before].grip == Grip::slide ? mu.kinetic : mu.statics;
}

void ParticleContacts::start_grip(const Bodies& bodies, const StepMotion& step, Contact& contact,
                                  const Contact* before) const {
  const Friction& mu = friction_of(bodies, contact);
  contact.last_slip = tangential(contact, step.velocity(contact.particle) - contact.body_velocity());
  contact.slip = contact.last_slip;
  contact.grip = before ? before->grip : mu.statics == 0 ? Grip::slide : Grip::stick;
  contact.arrival_impulse = arrival_impulse(contact, step);
  if (!before) {
    if (step.foresight != Foresight::ahead || contact.grip == Grip::slide || contact.slip.isZero(0)) return;
    contact.normal_impulse = contact.arrival_impulse;
    contact.grip = Grip::brake;
    return;
  }
  const double steady =
      std::max(0.0, before->normal_impulse - before->arrival_impulse) * step.h / step.last_h;
  contact.normal_impulse = steady + contact.arrival_impulse;
  if (before->grip != Grip::slide) return;
  const double arrived =
      (before->arrival_impulse - contact.arrival_impulse) * mu.kinetic / step.mass(contact.particle);
  const Vec3 expected =
      2 * contact.slip - before->last_slip + arrived / std::max(contact.slip.norm(), 1e-12) * contact.slip;
  const bool goes_on = expected.dot(contact.slip) > stop_fraction * contact.slip.squaredNorm();
  if (goes_on) contact.slip = expected;
  contact.grip = Grip::brake;
}

// A contact that is found within a step begins as it would if its particle, which moves with v, were alone.
void ParticleContacts::catch_grip(const Bodies& bodies, const StepMotion& step, Contact& contact,
                                  const Vec3& v) const {
  const Friction& mu = friction_of(bodies, contact);
  const Vec3 slip = tangential(contact, v - contact.body_velocity());
  contact.normal_impulse = arrival_impulse(contact, step, v);
  if (step.mass(contact.particle) * slip.norm() < mu.statics * contact.normal_impulse)
    contact.grip = Grip::stick;
  else
    slide_at(contact, mu.kinetic, slip);
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
    const Mat3 Q = c.locked_directions(), along = Mat3::Identity() - Q * Q.transpose();
    ContactFriction f{c.particle, c.plane[0].obstacle,  Mat3::Zero(), c.body_velocity(), Vec3::Zero(),
                      along,      mu * c.normal_impulse};
    Mat3 damped = along;
    if (c.grip == Grip::slide) {
      f.impulse = c.friction_impulse;
      const Vec3 t = c.friction_impulse.stableNormalized();
      damped -= t * t.transpose();
    }
    f.damping = rubbing(c, mu, step.mass(c.particle)) / step.h * damped;
    friction_.push_back(f);
  }
  rub_in_nips(bodies, step);
  return friction_;
}

// The mean velocity of a particle along its path, without the correction [m/s].
Vec3 ParticleContacts::mean_velocity(const StepMotion& step, int particle, const VecX& x_new) const {
  return (x_new.segment<3>(3 * particle) - step.place(particle) - correction_.segment<3>(3 * particle)) /
         step.h;
}

double ParticleContacts::imbalance(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r,
                                   const VecX& x_new) {
  double normal = 0, friction = 0;  // sums of squares
  std::size_t contacts = trial_.size();
  for (const Contact& c : trial_) {
    const Vec3 v_end = v.segment<3>(3 * c.particle), held = r.segment<3>(3 * c.particle);
    normal += std::pow(wrong_normal(step, c, mean_velocity(step, c.particle, x_new), held), 2);
    if (c.active() && !c.clamped) friction += std::pow(wrong_friction(bodies, step, c, v_end, held), 2);
  }
  for (const auto& found : found_) {
    contacts += found.size();
    for (const Contact& c : found)
      for (int k = 0; k < c.planes; ++k)
        normal += std::pow(passing_impulse(step, c, k, mean_velocity(step, c.particle, x_new)), 2);
  }
  unsettled_ = std::sqrt(normal / static_cast<double>(std::max<std::size_t>(contacts, 1)));
  return std::sqrt(normal + friction);
}

// The square root of the sum of squares of the impulses along the normals that should not be, or are missing.
double ParticleContacts::wrong_normal(const StepMotion& step, const Contact& c, const Vec3& v,
                                      const Vec3& r) const {
  if (c.clamped) return 0;
  double squares = 0;
  for (int k = c.planes; k < c.known; ++k) squares += std::pow(passing_impulse(step, c, k, v), 2);
  const std::array<double, 3> lambda = presses(c, r);
  for (int k = 0; k < c.planes; ++k) squares += std::pow(std::min(lambda[k], 0.0), 2);
  return std::sqrt(squares);
}

double ParticleContacts::wrong_friction(const Bodies& bodies, const StepMotion& step, const Contact& c,
                                        const Vec3& v, const Vec3& r) const {
  const Friction& mu = friction_of(bodies, c);
  const Vec3 slip = tangential(c, v - c.body_velocity());
  const double mass = step.mass(c.particle);
  const Vec3 given = given_friction(c, mu.kinetic, mass, slip, r), asked = given - mass * slip;
  const double most = (c.grip == Grip::stick ? sticking(c, mu) : mu.kinetic) * pressed(c, r);
  if (c.grip != Grip::stick && step.foresight != Foresight::ahead) return wrong_apart(c, given, most);
  return (given - (asked.norm() > most ? most * asked.normalized() : asked)).norm();
}

void ParticleContacts::settle(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r) {
  for (Contact& c : trial_) {
    if (!c.active() || c.clamped) continue;
    const std::array<double, 3> lambda = presses(c, r.segment<3>(3 * c.particle));
    for (int k = 0; k < c.planes; ++k) c.impulse[k] = std::max(lambda[k], 0.0);
    c.normal_impulse = pressed(c, r.segment<3>(3 * c.particle));
    const double slip = tangential(c, v.segment<3>(3 * c.particle) - c.body_velocity()).norm();
    const double most = friction_of(bodies, c).kinetic * c.normal_impulse;
    // Where contact is not part of the solve, what has come loose moves from the next step on.
    const bool waits = step.foresight != Foresight::ahead && c.grip == Grip::slide && c.changes > 0;
    if (!waits && step.mass(c.particle) * slip < stop_fraction * most) c.grip = Grip::stick;
  }
}

bool ParticleContacts::react(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r,
                             const VecX& x_new, double noise) {
  bool changed = false;
  for (Contact& c : trial_) {
    if (c.clamped) continue;
    const double too_small = noise * step.mass(c.particle);
    const Vec3 v_end = v.segment<3>(3 * c.particle), held = r.segment<3>(3 * c.particle);
    if (catch_again(step, c, mean_velocity(step, c.particle, x_new), held, too_small) ||
        (c.active() && update_grip(bodies, step, c, v_end, held, too_small)))
      changed = true;
  }
  return changed;
}

// Of the planes that were let go, the one that the particle passes through fastest holds it again.
bool ParticleContacts::catch_again(const StepMotion& step, Contact& c, const Vec3& v, const Vec3& r,
                                   double noise) const {
  int worst = -1;
  double most = noise;
  for (int k = c.planes; k < c.known; ++k)
    if (const double passing = passing_impulse(step, c, k, v); passing > most) {
      most = passing;
      worst = k;
    }
  if (worst < 0 || !hold_again(c, r, worst)) return false;
  ++c.catches;
  begin_anew(step, c);
  return true;
}

// What a contact knows of friction when a plane holds it that did not in the last solve.
void ParticleContacts::begin_anew(const StepMotion& step, Contact& c) const {
  c.arrival_impulse = arrival_impulse(c, step);
  if (c.planes > 1) {  // it slides in fewer directions
    for (Vec3* v : {&c.slip, &c.last_slip, &c.friction_impulse}) *v = tangential(c, *v);
    return;
  }
  // It slides without friction until a solve tells what bears on it. If it stuck, it might be let go again.
  c.grip = Grip::brake;
  c.normal_impulse = 0;
  c.last_slip = tangential(c, step.velocity(c.particle) - c.body_velocity());
  c.slip = c.last_slip;
}

bool ParticleContacts::update_grip(const Bodies& bodies, const StepMotion& step, Contact& c, const Vec3& v,
                                   const Vec3& r, double noise) const {
  const std::array<double, 3> lambda = presses(c, r);
  const auto weakest =
      static_cast<std::size_t>(std::min_element(lambda.begin(), lambda.begin() + c.planes) - lambda.begin());
  if (lambda[weakest] < -noise) {  // it would pull the particle towards the body, so it is let go
    let_go(c, static_cast<int>(weakest));
    if (step.foresight != Foresight::ahead) c.known = c.planes;  // it moves from the next step on
    c.arrival_impulse = arrival_impulse(c, step);
    if (!c.active()) return true;
    // The particle slides along the planes that still hold, in more directions than before.
    c.last_slip = tangential(c, step.velocity(c.particle) - c.body_velocity());
    c.slip = c.last_slip;
    return true;
  }
  return update_friction(bodies, step, c, v, r, noise);
}

// Newton's method for Coulomb's law as a projection: friction is what would stop the particle, but at most mu
// N.
//                                                                [Hueber, Stadler & Wohlmuth 2008, section 3]
bool ParticleContacts::update_friction(const Bodies& bodies, const StepMotion& step, Contact& c,
                                       const Vec3& v, const Vec3& r, double noise) const {
  const Friction& mu = friction_of(bodies, c);
  const double mass = step.mass(c.particle);
  const double inertia = internal::inertia_met(step, c.particle);
  const Vec3 slip = tangential(c, v - c.body_velocity());
  const Vec3 given = given_friction(c, mu.kinetic, mass, slip, r), asked = given - inertia * slip;
  // Friction may press the particle on, or lift it off, by more than it takes itself: then the impulse goes
  // up and down from solve to solve. A part of the change settles.
  const double pressing = pressed(c, r);
  const double change = pressing - c.normal_impulse;
  c.turns += change * c.last_change < 0;
  const bool in_doubt = c.catches > 0 || c.changes > 1 || c.turns > 1;
  c.relaxed = in_doubt ? relaxation(c, change) : 1;
  c.last_change = change;
  c.normal_impulse += c.relaxed * change;
  const double most = mu.kinetic * c.normal_impulse;
  if (c.grip != Grip::stick && step.foresight != Foresight::ahead) {
    const bool wrong = wrong_apart(c, given, most) > noise;
    c.friction_impulse = most * c.friction_impulse.stableNormalized();
    if (wrong) c.slip = slip;
    return wrong;
  }
  if (c.grip == Grip::stick) {
    const double holds = sticking(c, mu) * c.normal_impulse + std::max(noise, unsettled_);
    if (asked.norm() <= holds) return false;
    ++c.changes;
  } else if (asked.norm() < (1 - round_off) * most) {  // it stops, unless it has come loose again too often
    c.grip = c.changes < most_changes ? Grip::stick : Grip::brake;
    ++c.changes;
    c.slip = slip;
    return true;
  } else if (c.grip == Grip::brake && c.changes > most_changes && !may_slide_again(c, slip, given, most)) {
    c.slip = slip;
    return std::abs(given.norm() - most) > noise;
  } else if (c.grip == Grip::slide && slip.dot(c.slip) < 0) {  // the constant push turned the motion round
    c.grip = Grip::brake;
    c.slip *= 0.25;
    ++c.changes;
    return true;
  }
  slide_at(c, mu.kinetic, -(asked.norm() - most) / inertia * asked.stableNormalized());
  return (c.friction_impulse - given).norm() > noise;
}

}  // namespace drape
