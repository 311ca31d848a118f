#include "solver/forces/cluster_contacts.h"

#include <algorithm>

namespace drape {
namespace {

constexpr int most_sweeps = 200;
constexpr double exactness = 1e-12;  // of the largest velocity: what a sweep changes at the end
constexpr double stands = 1e-4;      // m/s: what slides less when the step begins is held by static friction

Vec3 at(const VecX& x, int particle) { return x.segment<3>(3 * particle); }

ClusterMotion sum(const ClusterMotion& a, const ClusterMotion& b) {
  return {a.velocity + b.velocity, a.spin + b.spin};
}

}  // namespace

ClusterContacts::ClusterContacts(const Clusters& clusters)
    : clusters_(clusters), number_(static_cast<std::size_t>(clusters.count()), unknown) {}

int ClusterContacts::body_of_cluster(int cluster, const CarriedMotion& motion) {
  int& number = number_[static_cast<std::size_t>(cluster)];
  if (number != unknown) return number;
  asked_.push_back(cluster);
  const auto members = clusters_[cluster];
  const bool held = std::any_of(members.begin(), members.end(),
                                [&](const ClusterMember& m) { return motion.held[m.particle] != 0; });
  if (held) return number = not_free;
  number = static_cast<int>(bodies_.size());
  const ClusterBody body = drape::body_of(members, motion.start);
  const ClusterMotion none{Vec3::Zero(), Vec3::Zero()};
  bodies_.push_back({cluster, body, motion_of(members, body, motion.start, motion.before),
                     motion_of(members, body, motion.start, motion.v), none, none});
  return number;
}

// The particles that touch and are in free clusters only.
void ClusterContacts::find(std::vector<CarriedContact>& met, const CarriedMotion& motion) {
  for (const int cluster : asked_) number_[static_cast<std::size_t>(cluster)] = unknown;
  asked_.clear();
  bodies_.clear();
  holds_.clear();
  meetings_.clear();
  const ClusterMotion none{Vec3::Zero(), Vec3::Zero()};
  by_impact_.assign(motion.bodies.size(), none);
  by_support_.assign(motion.bodies.size(), none);
  for (CarriedContact& contact : met) {
    const auto places = clusters_.places_of(contact.particle);
    const std::size_t first = holds_.size();
    Mat3 give = Mat3::Zero();
    bool free = !places.empty();
    for (const Clusters::Place& place : places) {
      const int number = body_of_cluster(place.cluster, motion);
      if (number == not_free) free = false;
      if (!free) break;
      const ClusterMember& member = clusters_.member(place);
      const ClusterBody& body = bodies_[static_cast<std::size_t>(number)].body;
      const Vec3 arm = at(motion.start, contact.particle) - body.centre;
      const double share = member.share / member.mass;
      holds_.push_back({number, share, arm});
      give += share * share * give_at(body, arm);
    }
    if (!free) {
      holds_.resize(first);
      push_obstacle(Phase::support, contact, -contact.impulse, motion);  // of other carriers
      continue;
    }
    contact.impulse.setZero();
    if (const CarriedBody& other = motion.bodies[static_cast<std::size_t>(contact.body)]; other.reacts)
      give += give_at({1 / other.inverse_mass, other.centre, other.inverse_inertia},
                      at(motion.start, contact.particle) - other.centre);
    const double along = contact.normal.dot(give * contact.normal);
    meetings_.push_back({.contact = &contact,
                         .first = static_cast<int>(first),
                         .last = static_cast<int>(holds_.size()),
                         .give_along = along,
                         .give_across = give.trace() - along,
                         .target = 0,
                         .mu = 0,
                         .lambda = Vec3::Zero()});
  }
}

ClusterMotion ClusterContacts::motion_in(Phase phase, const Body& body) {
  switch (phase) {
    case Phase::before:
      return body.before;
    case Phase::impact:
      return sum(body.before, body.impact);
    case Phase::support:
      break;
  }
  return sum(sum(body.free, body.impact), body.support);
}

ClusterMotion ClusterContacts::motion_in(Phase phase, std::size_t obstacle,
                                         const CarriedMotion& motion) const {
  const CarriedBody& body = motion.bodies[obstacle];
  const ClusterMotion before{body.velocity_before, body.spin_before};
  switch (phase) {
    case Phase::before:
      return before;
    case Phase::impact:
      return sum(before, by_impact_[obstacle]);
    case Phase::support:
      break;
  }
  return sum(sum({body.velocity, body.spin}, by_impact_[obstacle]), by_support_[obstacle]);
}

// The velocity of the particle with its clusters, as its obstacle sees it.
Vec3 ClusterContacts::slip(Phase phase, const Meeting& meeting, const CarriedMotion& motion) const {
  Vec3 u = Vec3::Zero();
  for (int k = meeting.first; k < meeting.last; ++k) {
    const Hold& hold = holds_[static_cast<std::size_t>(k)];
    u += hold.share * motion_in(phase, bodies_[static_cast<std::size_t>(hold.body)]).at(hold.arm);
  }
  const CarriedContact& contact = *meeting.contact;
  const auto obstacle = static_cast<std::size_t>(contact.body);
  if (!motion.bodies[obstacle].reacts) return u - contact.body_velocity;
  const Vec3 arm = at(motion.start, contact.particle) - motion.bodies[obstacle].centre;
  return u - motion_in(phase, obstacle, motion).at(arm);
}

void ClusterContacts::push_obstacle(Phase phase, const CarriedContact& contact, const Vec3& impulse,
                                    const CarriedMotion& motion) {
  const auto obstacle = static_cast<std::size_t>(contact.body);
  const CarriedBody& body = motion.bodies[obstacle];
  if (!body.reacts) return;
  ClusterMotion& change = (phase == Phase::impact ? by_impact_ : by_support_)[obstacle];
  change.velocity += body.inverse_mass * impulse;
  change.spin += body.inverse_inertia * (at(motion.start, contact.particle) - body.centre).cross(impulse);
}

void ClusterContacts::push(Phase phase, const Meeting& meeting, const Vec3& impulse,
                           const CarriedMotion& motion) {
  for (int k = meeting.first; k < meeting.last; ++k) {
    const Hold& hold = holds_[static_cast<std::size_t>(k)];
    Body& body = bodies_[static_cast<std::size_t>(hold.body)];
    ClusterMotion& change = phase == Phase::impact ? body.impact : body.support;
    const Vec3 part = hold.share * impulse;
    change.velocity += part / body.body.mass;
    change.spin += body.body.inverse_inertia * hold.arm.cross(part);
  }
  push_obstacle(phase, *meeting.contact, -impulse, motion);
}

// Corrects every impulse once; returns the largest change of a velocity [m/s]. An impact has no friction.
double ClusterContacts::sweep(Phase phase, const CarriedMotion& motion) {
  double largest = 0;
  for (Meeting& meeting : meetings_) {
    const Vec3& n = meeting.contact->normal;
    const Vec3 u = slip(phase, meeting, motion);
    const double before = meeting.lambda.dot(n),
                 along = std::max(0.0, before + (meeting.target - u.dot(n)) / meeting.give_along);
    Vec3 across = Vec3::Zero();
    if (phase == Phase::support && meeting.mu > 0) {
      across = meeting.lambda - before * n - (u - u.dot(n) * n) / meeting.give_across;
      const double most = meeting.mu * along, size = across.norm();
      if (size > most) across *= most / size;
    }
    const Vec3 more = along * n + across - meeting.lambda;
    meeting.lambda += more;
    push(phase, meeting, more, motion);
    largest = std::max(largest, more.norm() * (meeting.give_along + meeting.give_across));
  }
  return largest;
}

void ClusterContacts::settle(Phase phase, const CarriedMotion& motion) {
  double fastest = 0;
  for (const Meeting& meeting : meetings_)
    fastest = std::max(fastest, slip(phase, meeting, motion).norm() + std::abs(meeting.target));
  for (int k = 0; k < most_sweeps && sweep(phase, motion) > exactness * fastest; ++k) {
  }
}

// The share of the step that is left after the impact: the mean over those that meet the surface within it.
double ClusterContacts::part_after_impact(const CarriedMotion& motion) const {
  double sum = 0, weight = 0;
  for (const Meeting& meeting : meetings_) {
    const CarriedContact& c = *meeting.contact;
    const double push = meeting.lambda.dot(c.normal);
    const Vec3 way = at(motion.x, c.particle) - at(motion.start, c.particle) - motion.h * c.body_velocity;
    const double nearer = -way.dot(c.normal);
    sum += push * (c.gap > 0 && nearer > c.gap ? 1 - c.gap / nearer : 1);
    weight += push;
  }
  return weight > 0 ? sum / weight : 1;
}

// Moves all particles of the clusters that were pushed.
void ClusterContacts::move(double part, const CarriedMotion& motion) const {
  for (const Body& body : bodies_) {
    if (body.impact.velocity.isZero(0) && body.support.velocity.isZero(0) && body.impact.spin.isZero(0) &&
        body.support.spin.isZero(0))
      continue;
    for (const ClusterMember& m : clusters_[body.cluster]) {
      const Vec3 arm = at(motion.start, m.particle) - body.body.centre;
      const double share = m.share / m.mass;
      const Vec3 by_impact = share * body.impact.at(arm), by_support = share * body.support.at(arm);
      motion.before.segment<3>(3 * m.particle) += by_impact;
      motion.v.segment<3>(3 * m.particle) += by_impact + by_support;
      motion.x.segment<3>(3 * m.particle) += motion.h * (part * by_impact + by_support);
    }
  }
}

bool ClusterContacts::carry(std::vector<CarriedContact>& met, const CarriedMotion& motion) {
  find(met, motion);
  if (meetings_.empty()) return false;
  for (Meeting& meeting : meetings_) {
    const CarriedContact& c = *meeting.contact;
    const Vec3 u = slip(Phase::before, meeting, motion);
    const double approach = u.dot(c.normal);
    meeting.mu = (u - approach * c.normal).norm() > stands ? c.friction.kinetic : c.friction.statics;
    meeting.target = std::max(0.0, -c.restitution * approach);
  }
  double part = 1;
  if (motion.mode == ContactMode::restitution) {
    settle(Phase::impact, motion);
    part = part_after_impact(motion);
    for (Meeting& meeting : meetings_) {
      meeting.contact->impulse += meeting.lambda;
      meeting.lambda.setZero();
      meeting.target = 0;
    }
  } else {
    for (Meeting& meeting : meetings_)
      meeting.target = -std::max(meeting.contact->gap, -motion.recovery_speed * motion.h) / motion.h;
  }
  settle(Phase::support, motion);
  bool any = false;
  for (Meeting& meeting : meetings_) {
    meeting.contact->impulse += meeting.lambda;
    any = any || !meeting.contact->impulse.isZero(0);
  }
  if (any) move(part, motion);
  return any;
}

}  // namespace drape
