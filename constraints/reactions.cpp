// Constraints: what the particles do to the bodies, which may move otherwise than was expected.
#include <algorithm>

#include "constraints/constraints.h"

namespace drape {

// The other side of an impulse on a particle, which ends the step with v and is pushed at body_velocity.
void Constraints::push(int body, int particle, const Vec3& v, const Vec3& body_velocity,
                       const Vec3& impulse) {
  work_ += body_velocity.dot(impulse);
  bodies_[static_cast<std::size_t>(body)].push(-impulse, x_.segment<3>(3 * particle) + h_ * v,
                                               (body_velocity - v_.segment<3>(3 * particle)).norm());
}

void Constraints::receive(const VecX& v, const VecX& r) {
  work_ = 0;
  for (MovingBody& body : bodies_) body.clear_impulse();
  for (const Contact& c : trial_) {
    if (!c.active()) continue;
    Vec3 rest = r.segment<3>(3 * c.particle);
    const std::array<double, 3> lambda = multipliers(c, rest);
    for (int k = 1; k < c.planes; ++k) {  // of several bodies each has its plane's part
      const ContactPlane& p = c.plane[static_cast<std::size_t>(k)];
      const Vec3 part = lambda[static_cast<std::size_t>(k)] * p.normal;
      push(p.obstacle, c.particle, v.segment<3>(3 * c.particle), p.body_velocity, part);
      rest -= part;
    }
    push(c.plane[0].obstacle, c.particle, v.segment<3>(3 * c.particle), c.body_velocity(), rest);
  }
  for (const ContactFriction& f : friction_) {
    const Vec3 slip = v.segment<3>(3 * f.particle) - f.body_velocity;
    push(f.body, f.particle, v.segment<3>(3 * f.particle), f.body_velocity,
         f.impulse - h_ * (f.damping * slip));
  }
  receive_faces(v);
  for (const MovingPin& pin : moving_pins_) receive_pin(pin, r.segment<3>(3 * pin.particle));
}

void Constraints::receive_pin(const MovingPin& pin, const Vec3& impulse) {
  const Vec3 velocity = pin_velocity_.segment<3>(3 * pin.particle);
  if (pin.body < 0)
    work_ += velocity.dot(impulse);
  else
    push(pin.body, pin.particle, velocity, velocity, impulse);
}

void Constraints::receive_faces(const VecX& v) {
  if (faces_.touching().empty()) return;
  x_new_ = x_ + h_ * v + correction_;
  faces_.take_impulse(h_, x_new_, v);
  for (const FaceContact& c : faces_.touching()) {
    work_ += c.body_velocity.dot(c.impulse);
    bodies_[static_cast<std::size_t>(c.body)].push(-c.impulse, c.at(x_new_),
                                                   (c.at(v_) - c.body_velocity).norm());
  }
}

// Bodies that moved otherwise than they were taken to: their planes and pins move with them.
bool Constraints::move_bodies(double noise) {
  if (!two_way_) return false;
  bool moved = false;
  for (MovingBody& body : bodies_)
    if (body.correct(noise)) moved = true;
  if (!moved) return false;
  for (Contact& c : trial_) {
    c.changes = 0;
    for (int k = 0; k < c.planes; ++k) {
      ContactPlane& p = c.plane[static_cast<std::size_t>(k)];
      p.body_velocity = bodies_[static_cast<std::size_t>(p.obstacle)].velocity(x_.segment<3>(3 * c.particle));
    }
  }
  faces_.follow(bodies_);
  move_pins();
  return true;
}

bool Constraints::bodies_converged(double share) const {
  return std::all_of(bodies_.begin(), bodies_.end(), [share](const MovingBody& body) {
    return !body.reacting() || body.reacting()->converged(share);
  });
}

}  // namespace drape
