#include "constraints/particle_contacts.h"

#include <algorithm>

#include "mesh/base/parallel.h"

namespace drape {
namespace {

// What is laid at the margin may be off by rounding, and its particles must not be told apart by that [m].
constexpr double at_margin = 1e-9;

// Whether the contact knows a plane of this body, also one that was let go in this step.
bool knows(const Contact* contact, int obstacle) {
  if (!contact) return false;
  for (int k = 0; k < contact->known; ++k)
    if (contact->plane[k].obstacle == obstacle) return true;
  return false;
}

// Whether a plane of this body holds the particle.
bool holds(const Contact* contact, int obstacle) {
  if (!contact) return false;
  const auto begin = contact->plane.begin();
  return std::any_of(begin, begin + contact->planes,
                     [obstacle](const ContactPlane& p) { return p.obstacle == obstacle; });
}

// Whether the plane can hold the particle, too. It cannot where bodies pinch it from both sides.
bool can_hold(Contact contact, const ContactPlane& plane) {
  return add_or_exchange(contact, Vec3::Zero(), plane);
}

// The contact of a particle that is at x, where the body overlaps itself.
Contact clamped(int particle, const MovingBody& body, const SurfacePoint& start, const Vec3& x,
                double radius) {
  Contact contact{.particle = particle, .planes = 1, .known = 1, .plane = {}, .clamped = true};
  contact.plane[0] = body.plane_at(x, start.normal, start.distance - body.obstacle().margin - radius);
  return contact;
}

// Calls f(particle, chunk) for every particle that is not held.
template <class F>
void for_free(const StepMotion& step, const F& f) {
  const int n = static_cast<int>(step.held.size()), size = heavy_chunk_size(n);
  parallel_for(heavy_chunk_count(n), n < serial_below(Work::heavy), [&](int k) {
    for (int i = k * size; i < std::min(n, (k + 1) * size); ++i)
      if (!step.is_held(i)) f(i, static_cast<std::size_t>(k));
  });
}

// Takes what slides on a body to stick where friction can stop all of it within the step, and its slip is
// falling: the solve then tells whether it sticks. The damper of what slides would not stop it: near the
// angle of friction it only creeps more slowly. Single contacts are not tried, because their neighbours drag
// them on.
void stop_together(const ParticleContacts::Bodies& bodies, const StepMotion& step,
                   std::vector<Contact>& contacts) {
  for (const MovingBody& body : bodies) {
    const double mu = body.obstacle().friction.kinetic;
    if (mu == 0) continue;  // nothing stops what slides without friction
    const auto slides_on_it = [&](const Contact& c) {
      return c.grip == Grip::slide && c.plane[0].obstacle == body.number();
    };
    bool can_stop = true;
    double gained = 0;  // of the momentum along the body [N s]
    for (const Contact& c : contacts) {
      if (!slides_on_it(c)) continue;
      const double mass = step.mass(c.particle);
      can_stop = can_stop && mass * c.last_slip.norm() <= mu * c.normal_impulse;
      gained += mass * (c.slip.norm() - c.last_slip.norm());
    }
    if (!can_stop || gained > 0) continue;
    for (Contact& c : contacts)
      if (slides_on_it(c)) c.grip = Grip::stick;
  }
}

}  // namespace

void ParticleContacts::prepare(int particles, std::size_t bodies) {
  const auto n = static_cast<std::size_t>(particles);
  particles_ = n;
  clearance_.assign(n * bodies, 0.0);  // nothing is known yet, so the first step looks at every particle
  trial_.clear();
  committed_.clear();
  held_by_.assign(bodies, 0);
  if (bodies == 0) return;  // pins need no more memory than this
  committed_of_.assign(n, -1);
  contact_of_.assign(n, -1);
  nip_of_.assign(n, -1);
  nips_.clear();
  correction_ = VecX::Zero(3 * particles);
  const auto chunks = static_cast<std::size_t>(heavy_chunk_count(particles));
  found_.resize(chunks);
  responses_.resize(chunks);
  deepest_.resize(chunks);
  guarded_.resize(chunks);
  for (auto* contacts : {&first_, &all_}) contacts->reserve(n);
  trial_.reserve(n);  // so that no step allocates, however many particles touch
  committed_.reserve(n);
  friction_.reserve(2 * n);
  nips_.reserve(n);
  for (auto& found : found_) found.reserve(static_cast<std::size_t>(heavy_chunk_size(particles)));
}

void ParticleContacts::look_again() { std::fill(clearance_.begin(), clearance_.end(), 0.0); }

void ParticleContacts::open() {
  for (const Contact& c : trial_) {
    contact_of_[c.particle] = -1;
    correction_.segment<3>(3 * c.particle).setZero();
  }
  trial_.clear();
}

void ParticleContacts::find(const Bodies& bodies, const StepMotion& step) {
  for (std::size_t k = 0; k < found_.size(); ++k) {
    found_[k].clear();
    deepest_[k] = 0;
  }
  for_free(step, [&](int i, std::size_t k) { look_for(i, bodies, step, found_[k], deepest_[k]); });
  take_found(step.h);
  if (step.foresight == Foresight::ahead) stop_together(bodies, step, trial_);
}

void ParticleContacts::take_found(double h) {
  for (auto& found : found_) {
    for (const Contact& c : found) {
      contact_of_[c.particle] = static_cast<int>(trial_.size());
      trial_.push_back(c);
      std::array<double, 3> out = {};
      for (int k = 0; k < c.planes && !c.clamped; ++k) {
        const auto p = static_cast<std::size_t>(k);
        out[p] = std::clamp(-c.plane[p].gap, 0.0, recovery_speed_ * h);
      }
      correction_.segment<3>(3 * c.particle) = along_planes(c, out);
    }
    found.clear();
  }
}

void ParticleContacts::look_for(int particle, const Bodies& bodies, const StepMotion& step,
                                std::vector<Contact>& found, double& deepest) {
  const int old = committed_of_[particle];
  const Contact* before = old < 0 ? nullptr : &committed_[old];
  const Nip* const nip = nip_of(particle);
  Contact contact{.particle = particle, .plane = {}};
  for (const MovingBody& body : bodies) {
    const int o = body.number();
    if (nip && o == nip->other()) {
      deepest = std::max(deepest, step.radius_of(particle) - clearance(o, particle));
      continue;
    }
    const bool touched = knows(before, o) || (nip && o == nip->holder);
    if (!contact.clamped) look_at(body, step, touched, before, contact, deepest);
  }
  if (nip && !contact.active()) look_at(bodies[nip->other()], step, true, before, contact, deepest);
  if (!contact.active()) return;
  if (!contact.clamped) {
    const double touch = touching_range(bodies[contact.plane[0].obstacle].obstacle().margin);
    contact.comes_out = contact.plane[0].gap < -touch && (!before || before->comes_out);
    clamp_between(bodies, step, before, contact);
  }
  // What is known of friction is of the body that it was on.
  if (nip && before && before->plane[0].obstacle != contact.plane[0].obstacle) before = nullptr;
  if (!contact.clamped) start_grip(bodies, step, contact, before);
  found.push_back(contact);
}

// Adds to the contact the plane in which its particle touches the body.
void ParticleContacts::look_at(const MovingBody& body, const StepMotion& step, bool touched,
                               const Contact* before, Contact& contact, double& deepest) {
  const int particle = contact.particle;
  const Vec3 x = step.place(particle), v = step.velocity(particle);
  const double radius = step.radius_of(particle), margin = body.obstacle().margin, offset = margin + radius;
  const Vec3 x_new = step.foresight == Foresight::ahead ? Vec3(x + step.h * v) : body.carried(x);
  const double travel = body.travel(x, x_new), reach = offset + std::max(travel, touching_range(margin));
  double& clear = clearance(body.number(), particle);
  if (clear > reach) return;
  const SurfacePoint start = body.at_start(x);
  clear = start.distance;
  deepest = std::max(deepest, radius - start.distance);
  if (start.distance > reach) return;
  if (start.covered) {
    contact = clamped(particle, body, start, x, radius);
    return;
  }
  ContactPlane plane = body.plane(x, start, x + step.h * v, radius);
  const auto far = body.opposite(x, start, offset);
  if (far) {  // where a fold closes, the surface that is nearest at the end of the step may be the other side
    const ContactPlane near = body.plane_at(x, start.normal, start.distance - offset);
    if (plane.normal.dot(near.normal) < plane.normal.dot(far->normal)) plane = near;
  }
  const double inside = step.foresight == Foresight::ahead ? at_margin : 0;
  if (touched ? plane.gap < touching_range(margin)
              : plane.gap < inside && plane.gap + body.approach(x, x_new, plane) < inside) {
    add_deepest(contact, plane);
    if (far) look_into_fold(body, step, plane, *far, before, contact);
  } else if (plane.gap < travel) {
    if (const auto met = body.meeting(x, x_new, radius)) add_deepest(contact, *met);
  }
}

void ParticleContacts::look_on_path(const Bodies& bodies, const StepMotion& step, const VecX& x_new) {
  for (auto& found : found_) found.clear();
  for_free(step, [&](int i, std::size_t k) {
    const int known = contact_of_[i];
    if (known >= 0 && step.foresight != Foresight::ahead) return;
    look_along(i, bodies, step, known < 0 ? nullptr : &trial_[known], x_new.segment<3>(3 * i), found_[k]);
  });
}

bool ParticleContacts::catch_on_path(const Bodies& bodies, const StepMotion& step, const VecX& r,
                                     const VecX& x_new) {
  bool caught = false;
  for (auto& found : found_) {
    std::size_t kept = 0;
    for (Contact& c : found) {
      if (const int known = contact_of_[c.particle]; known >= 0) {
        if (hold_also(step, r.segment<3>(3 * c.particle), trial_[known], c)) caught = true;
        continue;
      }
      catch_grip(bodies, step, c, mean_velocity(step, c.particle, x_new));
      found[kept++] = c;
      caught = true;
    }
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(kept), found.end());
  }
  take_found(step.h);
  return caught;
}

// A particle that touches, with the reaction r, meets other bodies, too. False where it changes nothing.
bool ParticleContacts::hold_also(const StepMotion& step, const Vec3& r, Contact& contact,
                                 const Contact& met) {
  bool added = false;
  for (int k = 0; k < met.planes; ++k)
    if (add_or_exchange(contact, r, met.plane[k])) added = true;
  if (!added) return false;
  begin_anew(step, contact);
  return true;
}

void ParticleContacts::look_along(int particle, const Bodies& bodies, const StepMotion& step,
                                  const Contact* known, const Vec3& x_new, std::vector<Contact>& found) {
  if (known && known->clamped) return;
  const Vec3 x = step.place(particle);
  const double radius = step.radius_of(particle);
  const Nip* const nip = nip_of(particle);
  Contact contact{.particle = particle, .plane = {}};
  for (int o = 0; o < static_cast<int>(bodies.size()); ++o) {
    const MovingBody& body = bodies[o];
    if (knows(known, o) || (nip && o == nip->other() && holds(known, nip->holder))) continue;
    if (clearance(o, particle) > body.obstacle().margin + radius + body.travel(x, x_new)) continue;
    const auto met = body.meeting(x, x_new, radius);
    if (met && (!known || can_hold(*known, *met))) add_deepest(contact, *met);
  }
  if (!contact.active()) return;
  start_grip(bodies, step, contact, nullptr);
  found.push_back(contact);
}

void ParticleContacts::follow(const Bodies& bodies, const StepMotion& step) {
  for (Contact& c : trial_) {
    c.changes = 0;
    for (int k = 0; k < c.known; ++k) {
      ContactPlane& p = c.plane[k];
      if (bodies[p.obstacle].reacting())
        p.body_velocity = bodies[p.obstacle].velocity(step.place(c.particle));
    }
  }
}

void ParticleContacts::guard(const Bodies& bodies, const StepMotion& step, VecX& x_new, VecX& v_new,
                             ContactReport& report) {
  std::fill(guarded_.begin(), guarded_.end(), 0);
  for_free(step, [&](int i, std::size_t k) { guard(i, bodies, step, x_new, v_new, guarded_[k]); });
  for (std::size_t k = 0; k < found_.size(); ++k) {
    report.guarded += guarded_[k];
    report.deepest = std::max(report.deepest, deepest_[k]);
  }
}

void ParticleContacts::guard(int particle, const Bodies& bodies, const StepMotion& step, VecX& x_new,
                             VecX& v_new, int& guarded) {
  const Vec3 x = step.place(particle);
  const double radius = step.radius_of(particle);
  if (const int known = contact_of_[particle]; known >= 0 && trial_[known].clamped) {
    for (const MovingBody& body : bodies)
      clearance(body.number(), particle) = 0;  // it was looked for at one only
    return;
  }
  for (int o = 0; o < static_cast<int>(bodies.size()); ++o) {
    const MovingBody& body = bodies[o];
    Vec3 end = x_new.segment<3>(3 * particle);
    const double travel = body.travel(x, end), clear = clearance(o, particle);
    clearance(o, particle) = std::max(0.0, clear - travel);
    if (clear - radius >= travel) continue;
    const auto normal = body.stop(x, end, clear, radius);
    if (!normal) continue;
    x_new.segment<3>(3 * particle) = end;
    const double inward = (v_new.segment<3>(3 * particle) - body.velocity(x)).dot(*normal);
    if (inward < 0) v_new.segment<3>(3 * particle) -= inward * *normal;
    ++guarded;
  }
}

void ParticleContacts::commit() {
  for (const Contact& c : committed_) committed_of_[c.particle] = -1;
  committed_.clear();
  std::fill(held_by_.begin(), held_by_.end(), 0);
  for (const Contact& c : trial_) {
    if (!c.active()) continue;
    if (c.planes == 1 && !c.clamped) ++held_by_[c.plane[0].obstacle];
    committed_of_[c.particle] = static_cast<int>(committed_.size());
    committed_.push_back(c);
    committed_.back().known = c.planes;
    if (c.grip == Grip::brake) committed_.back().grip = Grip::slide;
  }
}

void ParticleContacts::renumber(const std::vector<int>& number) {
  for (Contact& c : committed_) c.particle = number[static_cast<std::size_t>(c.particle)];
}

}  // namespace drape
