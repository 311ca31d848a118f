#include "solver/forces/cluster_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape {
namespace {

constexpr double stands = 1e-4;   // m/s: what slides less when the step begins is held by static friction
constexpr double shallow = 1e-9;  // m: what is no deeper need not be brought out
constexpr double tolerated =
    0.01;  // of the thickness: by how much particles may come nearer within their clusters
constexpr double least_weight = 1e-3;  // of a particle that makes a pair one of its cluster

Vec3 at(const VecX& x, int particle) { return x.segment<3>(3 * particle); }

template <class Key>
Vec3 last_of(const std::vector<std::pair<Key, Vec3>>& sorted, const Key& key) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), key,
                                   [](const auto& one, const Key& other) { return one.first < other; });
  return at != sorted.end() && at->first == key ? at->second : Vec3(Vec3::Zero());
}

bool is_pushed(const Impulses::Body& body) {
  return std::any_of(body.changes.begin(), body.changes.end(), [](const ClusterMotion& change) {
    return !change.velocity.isZero(0) || !change.spin.isZero(0);
  });
}

}  // namespace

ClusterContacts::ClusterContacts(const std::vector<const Clusters*>& clusters) {
  int particles = 0;
  for (const Clusters* const some : clusters)
    for (int c = 0; c < some->count(); ++c) {
      clusters_.push_back((*some)[c]);
      for (const ClusterMember& m : (*some)[c]) particles = std::max(particles, m.particle + 1);
    }
  places_start_.assign(static_cast<std::size_t>(particles) + 1, 0);
  for (const auto& cluster : clusters_)
    for (const ClusterMember& m : cluster) ++places_start_[static_cast<std::size_t>(m.particle) + 1];
  for (std::size_t i = 1; i < places_start_.size(); ++i) places_start_[i] += places_start_[i - 1];
  places_.resize(places_start_.back());
  std::vector<std::size_t> next(places_start_.begin(), places_start_.end() - 1);
  for (std::size_t c = 0; c < clusters_.size(); ++c)
    for (const ClusterMember& m : clusters_[c])
      places_[next[static_cast<std::size_t>(m.particle)]++] = {static_cast<int>(c), m.share / m.mass};
  free_.resize(clusters_.size());
  const std::size_t bodies = clusters_.size() + next.size(), points = places_.size() + next.size();
  impulses_.reserve(bodies, points);
  inner_.reserve(bodies, points);
  carried_.reserve(bodies);
  numbered_.reserve(bodies);
  touches_.reserve(points);
  last_of_pairs_.reserve(points);
  last_of_contacts_.reserve(points);
}

std::span<const ClusterContacts::Place> ClusterContacts::places_of(int particle) const {
  const auto i = static_cast<std::size_t>(particle);
  if (i + 1 >= places_start_.size()) return {};
  return {places_.data() + places_start_[i], places_start_[i + 1] - places_start_[i]};
}

// Whether the particle is in free clusters only.
bool ClusterContacts::is_carried(int particle) const {
  const auto places = places_of(particle);
  return !places.empty() && std::all_of(places.begin(), places.end(), [this](const Place& place) {
    return free_[static_cast<std::size_t>(place.cluster)] != 0;
  });
}

// What is held may be held by a body, which only springs give their impulse: they answer such a pair.
bool ClusterContacts::is_taken(const SelfContact& pair, const std::vector<char>& held) const {
  if (pair.body >= 0) return false;
  for (const int particle : pair.particles)
    if (held[static_cast<std::size_t>(particle)] != 0) return false;
  bool carried = false;
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::abs(pair.weights[k]) < least_weight || !is_carried(pair.particles[k])) continue;
    carried = true;
    for (std::size_t l = 0; l < k; ++l) {
      if (pair.weights[k] * pair.weights[l] >= 0) continue;
      for (const Place& a : places_of(pair.particles[k]))
        for (const Place& b : places_of(pair.particles[l]))
          if (a.cluster == b.cluster) return false;
    }
  }
  return carried;
}

void ClusterContacts::take(std::vector<SelfContact>& pairs, const std::vector<char>& held) {
  for (std::size_t c = 0; c < clusters_.size(); ++c)
    free_[c] = std::none_of(clusters_[c].begin(), clusters_[c].end(), [&](const ClusterMember& m) {
      return held[static_cast<std::size_t>(m.particle)] != 0;
    });
  taken_ = 0;
  unsettled_ = 0;
  for (SelfContact& pair : pairs) {
    pair.by_carriers = is_taken(pair, held);
    taken_ += pair.by_carriers;
  }
}

// key: a cluster, or a particle after these.
int ClusterContacts::number_of(int key, const CarriedMotion& motion) {
  int& number = numbers_[static_cast<std::size_t>(key)];
  if (number != none) return number;
  numbered_.push_back(key);
  const int particle = key - static_cast<int>(clusters_.size());
  if (particle >= 0) {
    const auto i = static_cast<std::size_t>(particle);
    carried_.push_back({none, particle, at(motion.start, particle), 0, 0});
    return number = impulses_.add({.inverse_mass = motion.held[i] != 0 ? 0 : 1 / motion.masses[i],
                                   .inverse_inertia = Mat3::Zero(),
                                   .before = {at(motion.before, particle), Vec3::Zero()},
                                   .free = {at(motion.v, particle), Vec3::Zero()}});
  }
  const auto members = clusters_[static_cast<std::size_t>(key)];
  const ClusterBody body = body_of(members, motion.start);
  carried_.push_back({key, none, body.centre, 0, 0});
  return number = impulses_.add({.inverse_mass = 1 / body.mass,
                                 .inverse_inertia = body.inverse_inertia,
                                 .before = motion_of(members, body, motion.start, motion.before),
                                 .free = motion_of(members, body, motion.start, motion.v)});
}

// Adds the part of a particle to the point that is made next: of its clusters, which are pushed at this
// place, or its own.
void ClusterContacts::hold(int particle, double weight, const Vec3& place, const CarriedMotion& motion) {
  if (!is_carried(particle)) {
    impulses_.hold(number_of(static_cast<int>(clusters_.size()) + particle, motion), weight, Vec3::Zero());
    return;
  }
  for (const Place& in : places_of(particle)) {
    const int body = number_of(in.cluster, motion);
    const double share = weight * in.share;
    impulses_.hold(body, share, share * (place - carried_[static_cast<std::size_t>(body)].centre));
  }
}

void ClusterContacts::hold_pair(const SelfContact& pair, const CarriedMotion& motion) {
  bool carried = true;
  for (std::size_t k = 0; k < 4; ++k)
    carried = carried && (pair.weights[k] == 0 || is_carried(pair.particles[k]));
  const Vec3 half =
      carried ? Vec3(0.5 * pair.place) : Vec3(Vec3::Zero());  // of the way from one side to the other
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 place = at(motion.start, pair.particles[k]);
    if (pair.weights[k] != 0)
      hold(pair.particles[k], pair.weights[k], place - std::copysign(1.0, pair.weights[k]) * half, motion);
  }
}

// side: 1 or -1, of the obstacle in the point.
void ClusterContacts::hold_obstacle(int body, double side, const Vec3& place, const CarriedMotion& motion) {
  const CarriedBody& obstacle = motion.bodies[static_cast<std::size_t>(body)];
  if (!obstacle.reacts) return;
  int& number = obstacles_[static_cast<std::size_t>(body)];
  if (number == none) {
    carried_.push_back({none, none, obstacle.centre, 0, 0});
    number = impulses_.add({.inverse_mass = obstacle.inverse_mass,
                            .inverse_inertia = obstacle.inverse_inertia,
                            .before = {obstacle.velocity_before, obstacle.spin_before},
                            .free = {obstacle.velocity, obstacle.spin}});
  }
  impulses_.hold(number, side, side * (place - obstacle.centre));
}

// The pairs that were taken, and what their particles, and those of free clusters, meet of bodies.
void ClusterContacts::find(std::vector<CarriedContact>& met, std::vector<SelfContact>& pairs,
                           const CarriedMotion& motion) {
  numbers_.resize(clusters_.size() + motion.masses.size(), none);
  for (const int key : numbered_) numbers_[static_cast<std::size_t>(key)] = none;
  numbered_.clear();
  obstacles_.assign(motion.bodies.size(), none);
  impulses_.clear();
  carried_.clear();
  touches_.clear();
  for (SelfContact& pair : pairs) {
    if (!pair.by_carriers) continue;
    hold_pair(pair, motion);
    impulses_.add_point(pair.normal, Vec3::Zero()).guess = last_of(last_of_pairs_, pair.who);
    touches_.push_back(
        {nullptr, &pair, nullptr, pair.normal.dot(pair.place) - pair.thickness, pair.friction});
    pair.carried_force.setZero();
  }
  for (CarriedContact& contact : met) {
    contact.impulse.setZero();
    contact.taken = false;
    const std::size_t own = clusters_.size() + static_cast<std::size_t>(contact.particle);
    if (!is_carried(contact.particle) && numbers_[own] == none) continue;
    hold(contact.particle, 1, at(motion.start, contact.particle), motion);
    const bool reacts = motion.bodies[static_cast<std::size_t>(contact.body)].reacts;
    hold_obstacle(contact.body, -1, at(motion.start, contact.particle), motion);
    impulses_.add_point(contact.normal, reacts ? Vec3(Vec3::Zero()) : contact.body_velocity).guess =
        last_of(last_of_contacts_, {contact.particle, contact.body});
    touches_.push_back({&contact, nullptr, nullptr, contact.gap, 0});
    contact.taken = true;
  }
  find_bodies(motion);
}

// Where bodies touch each other, when one of them that reacts is touched by what is carried.
void ClusterContacts::find_bodies(const CarriedMotion& motion) {
  if (std::all_of(obstacles_.begin(), obstacles_.end(), [](int number) { return number == none; })) return;
  for (const BodyTouch& touch : motion.touches) {
    hold_obstacle(touch.a, 1, touch.place, motion);
    hold_obstacle(touch.b, -1, touch.place, motion);
    impulses_.add_point(touch.normal, -touch.carried).guess = touch.impulse;
    touches_.push_back({nullptr, nullptr, &touch, 0, touch.mu});
  }
}

// How a contact with a body rubs: what stands when the step begins is held by static friction.
void ClusterContacts::find_friction() {
  impulses_.begin(Phase::impact);
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const CarriedContact* const contact = touches_[k].contact;
    if (!contact) continue;
    const Impulses::Point& point = impulses_.points()[k];
    const Vec3 u = impulses_.slip(point);
    const bool slides = (u - u.dot(point.normal) * point.normal).norm() > stands;
    touches_[k].mu = slides ? contact->friction.kinetic : contact->friction.statics;
  }
}

// What the relative velocities along the normals are to be at least at the end of the phase, which has begun.
void ClusterContacts::set_targets(Phase phase, const CarriedMotion& motion) {
  const double deepest = -motion.recovery_speed * motion.h, slowest = phase == Phase::recovery ? deepest : 0;
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    Impulses::Point& point = impulses_.points()[k];
    const CarriedContact* const contact = touches_[k].contact;
    const bool by_speed = contact && motion.mode == ContactMode::velocity;
    point.target = -std::max(touches_[k].gap, by_speed ? deepest : slowest) / motion.h;
    point.mu = !contact || phase == Phase::support ? touches_[k].mu : 0;
    if (const BodyTouch* const bodies = touches_[k].bodies) {
      point.target = phase == Phase::recovery ? -std::numeric_limits<double>::max() : bodies->target;
      continue;
    }
    if (!contact || motion.mode == ContactMode::velocity || phase == Phase::recovery) continue;
    point.target = phase == Phase::impact
                       ? std::max(0.0, -contact->restitution * impulses_.slip(point).dot(point.normal))
                       : 0;
  }
}

void ClusterContacts::remember() {
  last_of_pairs_.clear();
  last_of_contacts_.clear();
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const Vec3& impulse = impulses_.points()[k].impulse;
    if (const SelfContact* const pair = touches_[k].pair)
      last_of_pairs_.emplace_back(pair->who, impulse);
    else if (touches_[k].contact)
      last_of_contacts_.emplace_back(std::pair(touches_[k].contact->particle, touches_[k].contact->body),
                                     impulse);
  }
}

void ClusterContacts::settle(Phase phase, const CarriedMotion& motion) {
  impulses_.begin(phase);
  set_targets(phase, motion);
  unsettled_ = std::max(unsettled_, impulses_.settle(phase));
}

// Moves what lies too deep. An obstacle gets nothing of this.
void ClusterContacts::bring_out(const CarriedMotion& motion) {
  if (std::none_of(touches_.begin(), touches_.end(), [](const Touch& touch) { return touch.gap < -shallow; }))
    return;
  for (std::size_t b = 0; b < carried_.size(); ++b) {
    if (carried_[b].cluster != none || carried_[b].particle != none) continue;
    impulses_.bodies()[b].inverse_mass = 0;
    impulses_.bodies()[b].inverse_inertia.setZero();
  }
  settle(Phase::recovery, motion);
}

// Gives the impulses of the phase that has ended to what they are of.
void ClusterContacts::take_impulses(double h) {
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const Vec3& impulse = impulses_.points()[k].impulse;
    if (touches_[k].contact)
      touches_[k].contact->impulse += impulse;
    else if (touches_[k].pair)
      touches_[k].pair->carried_force += impulse / h;
  }
}

// The part of the step that is left to each body after its impacts: the mean over the points where it is hit.
// It meets the surface of a body within the step, and a pair when the step begins.
void ClusterContacts::find_parts(const CarriedMotion& motion) {
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    const Impulses::Point& point = impulses_.points()[k];
    double part = 1;
    if (const CarriedContact* const c = touches_[k].contact; c && c->gap > 0) {
      const Vec3 way =
          at(motion.x, c->particle) - at(motion.start, c->particle) - motion.h * c->body_velocity;
      if (const double nearer = -way.dot(c->normal); nearer > c->gap) part -= c->gap / nearer;
    }
    const double push = point.impulse.dot(point.normal);
    for (const Impulses::Hold& hold : impulses_.holds(point)) {
      Carried& body = carried_[static_cast<std::size_t>(hold.body)];
      body.part += part * push;
      body.pushed += push;
    }
  }
}

// Moves all particles of the clusters that were pushed, and those on their own.
void ClusterContacts::move(const CarriedMotion& motion) const {
  for (std::size_t b = 0; b < carried_.size(); ++b) {
    const Impulses::Body& body = impulses_.bodies()[b];
    const Carried& carried = carried_[b];
    if (!is_pushed(body)) continue;
    const double part = carried.pushed > 0 ? carried.part / carried.pushed : 1;
    const auto move_one = [&](int particle, double share) {
      const Vec3 arm = at(motion.start, particle) - carried.centre;
      const auto by = [&](Phase phase) { return Vec3(share * body.change(phase).at(arm)); };
      const Vec3 by_impact = by(Phase::impact), by_support = by(Phase::support);
      motion.before.segment<3>(3 * particle) += by_impact;
      motion.v.segment<3>(3 * particle) += by_impact + by_support;
      motion.x.segment<3>(3 * particle) += motion.h * (part * by_impact + by_support + by(Phase::recovery));
    };
    if (carried.cluster != none)
      for (const ClusterMember& m : clusters_[static_cast<std::size_t>(carried.cluster)])
        move_one(m.particle, m.share / motion.masses[static_cast<std::size_t>(m.particle)]);
    else if (carried.particle != none)
      move_one(carried.particle, 1);
  }
}

// What particles that move within their clusters meet of bodies that react.
void ClusterContacts::meet_by_particle(const CarriedMotion& motion) {
  inner_.begin(motion);
  for (const Touch& touch : touches_) {
    if (!touch.contact || !motion.bodies[static_cast<std::size_t>(touch.contact->body)].reacts) continue;
    const int number = obstacles_[static_cast<std::size_t>(touch.contact->body)];
    const Impulses::Body& body = impulses_.bodies()[static_cast<std::size_t>(number)];
    inner_.add(*touch.contact, touch.gap, touch.mu, body.after(Phase::support), motion);
  }
  inner_.answer(motion);
}

// Parts the pairs whose particles come nearer within their clusters, each by itself and without friction.
// What is tolerated is more than sweeps leave of stiff bodies, which have to rub.
void ClusterContacts::part_particles(const CarriedMotion& motion) const {
  for (const Touch& touch : touches_) {
    if (!touch.pair) continue;
    const SelfContact& pair = *touch.pair;
    std::array<double, 4> ways;
    double gives_way = 0;
    Vec3 p = Vec3::Zero(), u = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(pair.particles[k]);
      ways[k] = motion.held[i] != 0 ? 0 : pair.weights[k] / motion.masses[i];
      gives_way += pair.weights[k] * ways[k];
      p += pair.weights[k] * (at(motion.x, pair.particles[k]) - at(motion.start, pair.particles[k]));
      u += pair.weights[k] * at(motion.v, pair.particles[k]);
    }
    const double in_way = -std::max(touch.gap, -motion.recovery_speed * motion.h) - pair.normal.dot(p),
                 in_speed = -std::max(touch.gap, 0.0) / motion.h - pair.normal.dot(u);
    if (in_way <= tolerated * pair.thickness) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 push = ways[k] / gives_way * pair.normal;
      motion.x.segment<3>(3 * pair.particles[k]) += std::max(in_way, 0.0) * push;
      motion.v.segment<3>(3 * pair.particles[k]) += std::max(in_speed, 0.0) * push;
    }
  }
}

void ClusterContacts::forget() {
  last_of_pairs_.clear();
  last_of_contacts_.clear();
}

bool ClusterContacts::carry(std::vector<CarriedContact>& met, std::vector<SelfContact>& pairs,
                            const CarriedMotion& motion) {
  find(met, pairs, motion);
  if (touches_.empty()) return false;
  find_friction();
  if (motion.mode == ContactMode::restitution) {
    settle(Phase::impact, motion);
    find_parts(motion);
    take_impulses(motion.h);
  }
  settle(Phase::support, motion);
  remember();
  take_impulses(motion.h);
  bring_out(motion);
  move(motion);
  meet_by_particle(motion);
  part_particles(motion);
  return true;
}

}  // namespace drape
