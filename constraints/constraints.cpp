#include "constraints/constraints.h"

#include <algorithm>
#include <cmath>

#include "constraints/contact_step.h"
#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"

namespace drape {

void Constraints::add(Obstacle obstacle) {
  bodies_.emplace_back(std::move(obstacle), static_cast<int>(bodies_.size()));
  meeting_.add(bodies_);
  step_.held.clear();  // so that prepare() makes all that is known of the particles anew
}

void Constraints::pin(int particle) { pin(std::vector<int>{particle}); }

void Constraints::pin(const std::vector<int>& particles) {
  pins_.pin(particles);
  step_.held.clear();
}

void Constraints::pin_to_body(const std::vector<int>& particles, int body, const VecX& x) {
  pins_.pin_to_body(particles, bodies_.at(static_cast<std::size_t>(body)), x);
  step_.held.clear();
}

void Constraints::pin_along(const std::vector<int>& particles, const Motion& motion, const VecX& x,
                            double t) {
  pins_.pin_along(particles, motion, x, t);
  step_.held.clear();
}

void Constraints::unpin(const std::vector<int>& particles) {
  pins_.unpin(particles);
  step_.held.clear();
}

void Constraints::stand_at(double t) {
  for (MovingBody& body : bodies_) body.stand_at(t);
}

void Constraints::set_radius(int particle, double radius) {
  if (!(radius >= 0) || !std::isfinite(radius))
    throw InputError("radius = " + std::to_string(radius) + " m: a radius is finite and not negative");
  if (particle < 0)
    throw InputError("radius of particle " + std::to_string(particle) + ": they count from 0");
  const auto i = static_cast<std::size_t>(particle);
  if (step_.radius.size() <= i) step_.radius.resize(i + 1, 0.0);
  step_.radius[i] = radius;
}

void Constraints::merge(const std::vector<int>& particle_of) {
  if (!step_.radius.empty()) {
    std::vector<double> radius;
    for (std::size_t i = 0; i < particle_of.size(); ++i) {
      const auto to = static_cast<std::size_t>(particle_of[i]);
      if (radius.size() <= to) radius.resize(to + 1, 0.0);
      radius[to] = std::max(radius[to], step_.radius_of(static_cast<int>(i)));
    }
    step_.radius = std::move(radius);
  }
  contacts_.renumber(particle_of);
  pins_.renumber(particle_of);
  faces_.renumber(particle_of);
  self_.renumber(particle_of);
  step_.held.clear();
  step_.x_end.resize(0);
}

void Constraints::part(const Parting& parting) {
  if (!step_.radius.empty()) {
    std::vector<double> radius;
    for (int original : parting.source) radius.push_back(step_.radius_of(original));
    step_.radius = std::move(radius);
  }
  contacts_.renumber(parting.number);
  pins_.part(parting);
  faces_.part(parting);
  self_.part(parting);
  step_.held.clear();
  step_.x_end.resize(0);
}

void Constraints::prepare(int particles, const std::vector<double>& masses) {
  const auto n = static_cast<std::size_t>(particles);
  if (step_.held.size() == n && step_.masses == masses && contacts_.prepared(particles, bodies_.size()))
    return;
  if (!pinned().empty() && (pinned().front() < 0 || pinned().back() >= particles))
    throw InputError("pins: particle " +
                     std::to_string(pinned().front() < 0 ? pinned().front() : pinned().back()) +
                     " is pinned, but there are " + std::to_string(particles) + " particles, counted from 0");
  step_.masses = masses;
  step_.held.assign(n, 0);
  for (int i : pinned()) step_.held.at(static_cast<std::size_t>(i)) = 1;
  for (std::size_t i = 0; i < n; ++i)
    if (masses[i] == 0) step_.held[i] = 1;
  contacts_.prepare(particles, bodies_.size());
}

ContactStep Constraints::begin_step(const VecX& x, const VecX& v, const std::vector<double>& masses, double t,
                                    double h, Foresight foresight, const SelfSprings& springs) {
  prepare(static_cast<int>(x.size() / 3), masses);
  step_.t = t;
  step_.h = h;
  step_.foresight = foresight;
  carried_by_ = last_carried_by_;  // as bodies that react expect the impulses of the last completed step
  for (auto& [impulse, moment] : carried_by_) {
    const double share = step_.last_h > 0 ? h / step_.last_h : 0;
    impulse *= share;
    moment *= share;
  }
  step_.work = 0;
  if (x.size() != step_.x_end.size() || x != step_.x_end) {  // the state was changed from outside
    contacts_.look_again();
    if (x.size() == step_.x_end.size())
      faces_.look_again();  // else it knows of the other particles, and of its contacts
    self_.look_again();
  }
  step_.x = x;
  step_.v = v;
  step_.inertia = masses;
  for (MovingBody& body : bodies_) body.begin_step(t, h);
  if (bodies_.size() > 1) contacts_.find_nips(bodies_, step_);
  meeting_.begin_step(bodies_, contacts_.nips(), h, options_.recovery_speed);
  pins_.move(bodies_, step_);
  if (foresight == Foresight::ahead)
    for (const MovingPin& pin : moving_pins())  // what is led moves as it is led now, not as it came
      if (pin.body < 0 || !bodies_[pin.body].reacting())
        step_.v.segment<3>(3 * pin.particle) = pins_.velocity(pin.particle);
  if (!bodies_.empty()) {
    contacts_.open();
    if (foresight != Foresight::none) contacts_.find(bodies_, step_);
    x_new_ = x;
    if (foresight == Foresight::ahead) x_new_ += h * step_.v;
    if (!faces_.all().empty()) {
      faces_.begin_step(bodies_, contacts_.touching(), x, x_new_, foresight, options_.recovery_speed * h);
      if (foresight != Foresight::ahead) faces_.limit_dampers(masses, h);
    }
  }
  self_.begin_step(step_, bodies_, options_.recovery_speed * h, springs);
  if (foresight != Foresight::none)
    for (const Contact& contact : contacts_.touching())
      if (contact.planes > 0 && step_.radius_of(contact.particle) == 0)
        self_.pinch(contact, bodies_[contact.plane[0].obstacle]);
  return ContactStep(*this);
}

void Constraints::keep() {
  for (MovingBody& body : bodies_) body.keep();
  kept_carried_by_ = last_carried_by_;
}

void Constraints::go_back() {
  for (MovingBody& body : bodies_) body.go_back();
  last_carried_by_ = kept_carried_by_;
}

std::vector<double> Constraints::penetration(const VecX& x) const {
  std::vector<double> depth(static_cast<std::size_t>(x.size() / 3), 0.0);
  const int n = static_cast<int>(depth.size());
  for_chunks<Work::heavy>(n, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      for (const MovingBody& body : bodies_)
        depth[i] = std::max(depth[i], radius_of(i) - body.distance(x.segment<3>(3 * i)));
  });
  for (const MovingPin& pin : moving_pins())  // a body may hold it inside
    if (pin.body >= 0) depth[static_cast<std::size_t>(pin.particle)] = 0;
  return depth;
}

}  // namespace drape
