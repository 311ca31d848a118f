#include "solver/forces/inner_contacts.h"

#include <algorithm>
#include <limits>

namespace drape {
namespace {

constexpr int none = -1;

Vec3 at(const VecX& x, int particle) { return x.segment<3>(3 * particle); }

}  // namespace

void InnerContacts::reserve(std::size_t bodies, std::size_t points) {
  impulses_.reserve(bodies, points);
  touches_.reserve(points);
}

void InnerContacts::begin(const CarriedMotion& motion) {
  impulses_.clear();
  touches_.clear();
  numbers_.assign(motion.bodies.size(), none);
}

void InnerContacts::add(CarriedContact& contact, double gap, double mu, const ClusterMotion& body,
                        const CarriedMotion& motion) {
  const CarriedBody& obstacle = motion.bodies[static_cast<std::size_t>(contact.body)];
  int& number = numbers_[static_cast<std::size_t>(contact.body)];
  if (number == none)
    number = impulses_.add({.inverse_mass = obstacle.inverse_mass,
                            .inverse_inertia = obstacle.inverse_inertia,
                            .before = body,
                            .free = body});
  const bool known = !touches_.empty() && touches_.back().contact->particle == contact.particle;
  const ClusterMotion own = {at(motion.v, contact.particle), Vec3::Zero()};
  const double mass = motion.masses[static_cast<std::size_t>(contact.particle)];
  const int particle =
      known ? touches_.back().particle
            : impulses_.add(
                  {.inverse_mass = 1 / mass, .inverse_inertia = Mat3::Zero(), .before = own, .free = own});
  impulses_.hold(particle, 1, Vec3::Zero());
  impulses_.hold(number, -1, obstacle.centre - at(motion.start, contact.particle));
  impulses_.add_point(contact.normal, Vec3::Zero());
  touches_.push_back({&contact, gap, mu, particle, number});
}

// How deep the particle ends the step inside, or deeper inside than it can be brought out in one step [m].
double InnerContacts::depth(const Touch& touch, const CarriedMotion& motion) const {
  const CarriedContact& contact = *touch.contact;
  const Vec3 start = at(motion.start, contact.particle);
  const Vec3 arm = start - motion.bodies[static_cast<std::size_t>(contact.body)].centre;
  const Impulses::Body& body = impulses_.bodies()[static_cast<std::size_t>(touch.body)];
  const Vec3 way = at(motion.x, contact.particle) - start - motion.h * body.now.at(arm);
  return -std::max(touch.gap, -motion.recovery_speed * motion.h) - way.dot(contact.normal);
}

void InnerContacts::answer(const CarriedMotion& motion) {
  constexpr double least = 1e-12;  // m: round-off
  constexpr double free = -std::numeric_limits<double>::max();
  impulses_.begin(Phase::support);
  bool any = false;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    Impulses::Point& point = impulses_.points()[k];
    const double in = depth(touches_[k], motion);
    any = any || in > least;
    point.mu = touches_[k].mu;
    point.target = motion.mode == ContactMode::velocity
                       ? -std::max(touches_[k].gap, -motion.recovery_speed * motion.h) / motion.h
                   : in > least ? 0
                                : free;
  }
  if (!any) return;
  impulses_.settle(Phase::support);
  int last = none;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    touches_[k].contact->impulse += impulses_.points()[k].impulse;
    const int particle = touches_[k].contact->particle;
    if (particle == last) continue;
    last = particle;
    const Vec3& change =
        impulses_.bodies()[static_cast<std::size_t>(touches_[k].particle)].change(Phase::support).velocity;
    motion.v.segment<3>(3 * particle) += change;
    motion.x.segment<3>(3 * particle) += motion.h * change;
  }
}

}  // namespace drape
