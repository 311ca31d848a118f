// Particles that two bodies pinch: constraints/nip.h.
#include <algorithm>
#include <utility>

#include "constraints/particle_contacts.h"

namespace drape {
namespace {

// Two surfaces pinch what is between them when one normal is at most as far from the opposite of the other as this cosine says.
constexpr double facing = 0.9;
constexpr double still = 1e-9;  // m/s: a smaller slip is not told from none

// Whether friction could stop the slip v - v_body of a particle at x within a step, if the body alone gave way. A body that does
// not react gives no way. share: the length of this step over that of the last.
bool could_stop(const MovingBody& body, const Vec3& normal, const Vec3& x, const Vec3& v, double share) {
  const ReactingBody* const reacting = body.reacting();
  if (!reacting) return false;
  const Vec3 slip = v - reacting->velocity() - reacting->spin().cross(x - reacting->centre());
  const double pressed = share * reacting->impulse_of_bodies().norm() / reacting->mass();  // m/s
  return (slip - slip.dot(normal) * normal).norm() <= 2 * body.obstacle().friction.kinetic * pressed;
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
  const auto roughness = [&bodies](int o) { return bodies[o].obstacle().friction.kinetic; };
  const bool a_holds = roughness(a) != roughness(b) ? roughness(a) > roughness(b) : !bodies[a].reacting();
  const int holder = a_holds ? a : b;
  const bool slides = contact.grip == Grip::slide && contact.plane[0].obstacle == holder &&
                      !could_stop(bodies[holder], contact.plane[0].normal, x, step.velocity(particle),
                                  step.last_h > 0 ? step.h / step.last_h : 1);
  nip_of_[particle] = static_cast<int>(nips_.size());
  nips_.push_back({.particle = particle,
                   .a = a,
                   .b = b,
                   .holder = holder,
                   .runs = slides && step.foresight == Foresight::ahead,
                   .touch = {x, (at_b.normal - at_a.normal).normalized(), gap}});
}

std::array<double, 3> ParticleContacts::presses(const Contact& contact, const Vec3& r) const {
  std::array<double, 3> lambda = multipliers(contact, r);
  if (const Nip* const nip = nip_of(contact.particle))
    for (int k = 0; k < contact.planes; ++k)
      if (contact.plane[k].obstacle == nip->holder) lambda[k] += nip->impulse;
  return lambda;
}

double ParticleContacts::pressed(const Contact& contact, const Vec3& r) const {
  const std::array<double, 3> presses = this->presses(contact, r);
  double sum = 0;
  for (int k = 0; k < contact.planes; ++k) sum += std::max(presses[k], 0.0);
  return sum;
}

// By Coulomb's law where the slip is too fast to stop within the step, otherwise by a damper that cannot turn it round.
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
