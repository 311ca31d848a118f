// Applies the response of constraints/response.h to a free motion; it takes the place of a filter.
#include <algorithm>
#include <iterator>

#include "constraints/particle_contacts.h"
#include "mesh/base/parallel.h"

namespace drape {
namespace {

// A particle that touches several bodies at once goes from one to the next in at most this many rounds.
constexpr int most_rounds = 8;

}  // namespace

void ParticleContacts::respond(ContactMode mode, const Bodies& bodies, const StepMotion& step, const VecX& x,
                               const VecX& v, VecX& x_new, VecX& v_new) {
  const int n = static_cast<int>(x.size() / 3), size = heavy_chunk_size(n);
  x_new = x;
  v_new = v;
  parallel_for(heavy_chunk_count(n), n < serial_below(Work::heavy), [&](int k) {
    const auto chunk = static_cast<std::size_t>(k);
    found_[chunk].clear();
    responses_[chunk].clear();
    responses_[chunk].reserve(3 * static_cast<std::size_t>(size));
    deepest_[chunk] = 0;
    for (int i = k * size; i < std::min(n, (k + 1) * size); ++i)
      if (!step.is_held(i)) respond(mode, i, bodies, step, chunk, x_new, v_new);
  });
  trial_.clear();
  for (const auto& found : found_) trial_.insert(trial_.end(), found.begin(), found.end());
}

void ParticleContacts::respond_again(ContactMode mode, const Bodies& bodies, const StepMotion& step,
                                     const VecX& x, const VecX& v, VecX& x_new, VecX& v_new) {
  first_.swap(trial_);
  respond(mode, bodies, step, x, v, x_new, v_new);
  all_.clear();
  std::set_union(trial_.begin(), trial_.end(), first_.begin(), first_.end(), std::back_inserter(all_),
                 [](const Contact& a, const Contact& b) { return a.particle < b.particle; });
  trial_.swap(all_);
}

void ParticleContacts::respond(ContactMode mode, int particle, const Bodies& bodies, const StepMotion& step,
                               std::size_t chunk, VecX& x_new, VecX& v_new) {
  const Vec3 x = step.place(particle);
  StepVelocities velocities{step.velocity(particle), v_new.segment<3>(3 * particle),
                            (x_new.segment<3>(3 * particle) - x) / step.h};
  Contact contact{.particle = particle, .plane = {}, .grip = Grip::slide};
  bool again = true;
  for (int round = 0; again && round < most_rounds; ++round) {
    again = false;
    for (const MovingBody& body : bodies)
      if (respond(mode, body, step, chunk, velocities, contact)) again = bodies.size() > 1;
  }
  if (!contact.active()) return;
  found_[chunk].push_back(contact);
  x_new.segment<3>(3 * particle) = x + step.h * velocities.mean;
  v_new.segment<3>(3 * particle) = velocities.end;
}

bool ParticleContacts::respond(ContactMode mode, const MovingBody& body, const StepMotion& step,
                               std::size_t chunk, StepVelocities& velocities, Contact& contact) {
  const Obstacle& obstacle = body.obstacle();
  const double h = step.h;
  const Vec3 x = step.place(contact.particle), x_mean = x + h * velocities.mean;
  const double reach = std::max(body.travel(x, x_mean), body.travel(x, x + h * velocities.end));
  const double touch = touching_range(obstacle.margin);
  const double radius = step.radius_of(contact.particle), offset = obstacle.margin + radius;
  if (clearance(body.number(), contact.particle) > offset + std::max(reach, touch)) return false;
  const Vec3 before = velocities.end;
  const auto changed_by = [&](const ContactPlane& plane) {
    const bool changed = mode == ContactMode::velocity
                             ? project(velocities, plane, obstacle.friction, recovery_speed_, h)
                             : rebound(velocities, plane, obstacle.friction, obstacle.restitution,
                                       contact_layer(obstacle.margin), recovery_speed_, h);
    if (!changed) return false;
    add_deepest(contact, plane);
    const Vec3 impulse = step.mass(contact.particle) * (velocities.end - before);
    responses_[chunk].push_back({contact.particle, body.number(), impulse, x + h * velocities.mean,
                                 plane.body_velocity, (plane.body_velocity - before).norm(), plane.normal,
                                 plane.gap});
    return true;
  };
  const SurfacePoint start = body.at_start(x);
  clearance(body.number(), contact.particle) = start.distance;
  deepest_[chunk] = std::max(deepest_[chunk], radius - start.distance);
  if (start.covered || start.distance > offset + std::max(reach, touch)) return false;
  const ContactPlane nearest = body.plane(x, start, x_mean, radius);
  if (nearest.gap < touch && changed_by(nearest)) return true;
  if (!(nearest.gap < reach)) return false;
  const auto met = body.meeting(x, x_mean, radius);
  return met && changed_by(*met);
}

}  // namespace drape
