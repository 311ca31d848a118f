// Constraints, with the response of constraints/response.h in the place of a filter.
#include <algorithm>

#include "constraints/constraints.h"
#include "mesh/base/parallel.h"

namespace drape {
namespace {

// Between bodies that a particle touches at once the response goes round so often at most.
constexpr int most_rounds = 8;

}  // namespace

void Constraints::begin_response(const VecX& x, const VecX& v, const std::vector<double>& masses, double t,
                                 double h) {
  open_step(x, v, masses, t, h);
  if (bodies_.empty()) return;
  if (!faces_.all().empty()) {
    faces_.begin_step(bodies_, x_, x_, options_.recovery_speed * h_);
    faces_.limit_dampers(masses_, h_);
  }
  if (responses_.size() == found_.size()) return;
  responses_.resize(found_.size());
  for (auto& responses : responses_) responses.reserve(3 * chunk_size);
}

void Constraints::respond(ContactMode mode, const VecX& x, const VecX& v, const VecX& pulled, VecX& x_new,
                          VecX& v_new, double noise) {
  const int n = static_cast<int>(x.size() / 3);
  bool moved = false;
  for (bool again = true; again; moved = moved || again) {
    x_new = x;
    v_new = v;
    parallel_for(chunk_count(n), n < serial_below, [&](int k) {
      const auto chunk = static_cast<std::size_t>(k);
      found_[chunk].clear();
      responses_[chunk].clear();
      deepest_[chunk] = 0;
      for (int i = k * chunk_size; i < std::min(n, (k + 1) * chunk_size); ++i)
        if (!held(i)) respond(mode, i, chunk, x_new, v_new);
    });
    take_responses(v_new, pulled);
    again = move_bodies(noise);
  }
  if (!moved) return;
  for (const MovingPin& pin : moving_pins_) {  // with the body as it moves now
    const Vec3 velocity = pin_velocity_.segment<3>(3 * pin.particle);
    x_new.segment<3>(3 * pin.particle) = x_.segment<3>(3 * pin.particle) + h_ * velocity;
    v_new.segment<3>(3 * pin.particle) = velocity;
  }
}

void Constraints::take_responses(const VecX& v_new, const VecX& pulled) {
  trial_.clear();
  for (const auto& found : found_) trial_.insert(trial_.end(), found.begin(), found.end());
  work_ = 0;
  for (MovingBody& body : bodies_) body.clear_impulse();
  for (const auto& responses : responses_)
    for (const Response& r : responses) {
      work_ += r.body_velocity.dot(r.impulse);
      bodies_[static_cast<std::size_t>(r.body)].push(-r.impulse, r.place, r.approach);
    }
  receive_faces(v_new);
  for (const MovingPin& pin : moving_pins_) {
    const Vec3 brought = pin_velocity_.segment<3>(3 * pin.particle) - v_.segment<3>(3 * pin.particle);
    receive_pin(
        pin, pulled.segment<3>(3 * pin.particle) + masses_[static_cast<std::size_t>(pin.particle)] * brought);
  }
}

void Constraints::respond(ContactMode mode, int particle, std::size_t chunk, VecX& x_new, VecX& v_new) {
  const Vec3 x = x_.segment<3>(3 * particle);
  StepVelocities step{v_.segment<3>(3 * particle), v_new.segment<3>(3 * particle),
                      (x_new.segment<3>(3 * particle) - x) / h_};
  Contact contact{.particle = particle, .plane = {}, .grip = Grip::slide};
  bool again = true;
  for (int round = 0; again && round < most_rounds; ++round) {
    again = false;
    for (int body = 0; body < static_cast<int>(bodies_.size()); ++body)
      if (respond(mode, body, chunk, step, contact)) again = bodies_.size() > 1;
  }
  if (!contact.active()) return;
  found_[chunk].push_back(contact);
  x_new.segment<3>(3 * particle) = x + h_ * step.mean;
  v_new.segment<3>(3 * particle) = step.end;
}

bool Constraints::respond(ContactMode mode, int number, std::size_t chunk, StepVelocities& step,
                          Contact& contact) {
  const MovingBody& body = bodies_[static_cast<std::size_t>(number)];
  const Obstacle& obstacle = body.obstacle();
  const Vec3 x = x_.segment<3>(3 * contact.particle), x_mean = x + h_ * step.mean;
  const double reach = std::max(body.travel(x, x_mean), body.travel(x, x + h_ * step.end));
  const double touch = touching_range(obstacle.margin);
  if (clearance(number, contact.particle) > obstacle.margin + std::max(reach, touch)) return false;
  const Vec3 before = step.end;
  const auto changed_by = [&](const ContactPlane& plane) {
    const bool changed = mode == ContactMode::velocity
                             ? project(step, plane, obstacle.friction, options_.recovery_speed, h_)
                             : rebound(step, plane, obstacle.friction, obstacle.restitution,
                                       contact_layer(obstacle.margin), options_.recovery_speed, h_);
    if (!changed) return false;
    add_plane(contact, plane);
    const Vec3 impulse = masses_[static_cast<std::size_t>(contact.particle)] * (step.end - before);
    responses_[chunk].push_back(
        {number, impulse, x + h_ * step.mean, plane.body_velocity, (plane.body_velocity - before).norm()});
    return true;
  };
  const SurfacePoint start = body.at_start(x);
  clearance(number, contact.particle) = start.distance;
  deepest_[chunk] = std::max(deepest_[chunk], -start.distance);
  if (start.distance > obstacle.margin + std::max(reach, touch)) return false;
  const ContactPlane nearest = body.plane(x, start, x_mean);
  if (nearest.gap < touch && changed_by(nearest)) return true;
  if (!(nearest.gap < reach)) return false;
  const auto met = body.meeting(x, x_mean);
  return met && changed_by(*met);
}

}  // namespace drape
