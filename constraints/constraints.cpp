#include "constraints/constraints.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/parallel.h"

namespace drape {
namespace {

const ContactPlane* plane_with(const Contact* contact, int obstacle) {
  if (!contact) return nullptr;
  for (int k = 0; k < contact->planes; ++k)
    if (const ContactPlane& p = contact->plane[static_cast<std::size_t>(k)]; p.obstacle == obstacle)
      return &p;
  return nullptr;
}

}  // namespace

void Constraints::add(Obstacle obstacle) {
  bodies_.emplace_back(std::move(obstacle), static_cast<int>(bodies_.size()));
  two_way_ = two_way_ || bodies_.back().reacting();
  clearance_.clear();
}

void Constraints::pin(int particle) { pin(std::vector<int>{particle}); }

void Constraints::pin(const std::vector<int>& particles) {
  pinned_.insert(pinned_.end(), particles.begin(), particles.end());
  std::sort(pinned_.begin(), pinned_.end());
  pinned_.erase(std::unique(pinned_.begin(), pinned_.end()), pinned_.end());
  held_.clear();
}

void Constraints::pin_to_body(const std::vector<int>& particles, int body, const VecX& x) {
  for (int i : particles)
    if (!std::binary_search(pinned_.begin(), pinned_.end(), i))
      moving_pins_.push_back(
          {i, body, -1, bodies_.at(static_cast<std::size_t>(body)).mark(x.segment<3>(3 * i))});
  pin(particles);
}

void Constraints::pin_along(const std::vector<int>& particles, const Motion& motion, const VecX& x) {
  const int path = static_cast<int>(paths_.size());
  paths_.push_back(motion);
  const Pose start = motion.at(0);
  for (int i : particles)
    if (!std::binary_search(pinned_.begin(), pinned_.end(), i))
      moving_pins_.push_back({i, -1, path, {start.to_body(x.segment<3>(3 * i)), {}}});
  pin(particles);
}

// The velocity that brings each to where it is carried by the end of the step.
void Constraints::move_pins() {
  if (moving_pins_.empty()) return;
  pin_velocity_.setZero(x_.size());
  for (const MovingPin& pin : moving_pins_) {
    const Vec3 end = pin.body < 0
                         ? paths_[static_cast<std::size_t>(pin.path)].at(t_ + h_).to_world(pin.mark.place)
                         : bodies_[static_cast<std::size_t>(pin.body)].carried(pin.mark);
    pin_velocity_.segment<3>(3 * pin.particle) = (end - x_.segment<3>(3 * pin.particle)) / h_;
  }
}

void Constraints::merge(const std::vector<int>& particle_of) {
  const auto number = [&](int i) { return particle_of[static_cast<std::size_t>(i)]; };
  std::vector<int> first(particle_of.size(), -1);  // pin of a number
  for (int i : pinned_)
    if (int& owner = first[static_cast<std::size_t>(number(i))]; owner < 0) owner = i;
  std::erase_if(moving_pins_, [&](const MovingPin& pin) {
    return first[static_cast<std::size_t>(number(pin.particle))] != pin.particle;
  });
  for (MovingPin& pin : moving_pins_) pin.particle = number(pin.particle);
  for (int& i : pinned_) i = number(i);
  std::sort(pinned_.begin(), pinned_.end());
  pinned_.erase(std::unique(pinned_.begin(), pinned_.end()), pinned_.end());
  faces_.renumber(particle_of);
  held_.clear();  // all that is known of particles is prepared anew
  x_end_.resize(0);
}

void Constraints::prepare(int particles, const std::vector<double>& masses) {
  const auto n = static_cast<std::size_t>(particles);
  if (held_.size() == n && masses_ == masses && clearance_.size() == n * bodies_.size()) return;
  masses_ = masses;
  held_.assign(n, 0);
  for (int i : pinned_) held_.at(static_cast<std::size_t>(i)) = 1;
  for (std::size_t i = 0; i < n; ++i)
    if (masses[i] == 0) held_[i] = 1;
  clearance_.assign(n * bodies_.size(), 0.0);  // nothing known yet: look at once
  trial_.clear();
  committed_.clear();
  if (bodies_.empty()) return;  // pins need no more memory than this
  committed_of_.assign(n, -1);
  contact_of_.assign(n, -1);
  correction_ = VecX::Zero(3 * particles);
  const auto chunks = static_cast<std::size_t>(chunk_count(particles));
  found_.resize(chunks);
  deepest_.resize(chunks);
  guarded_.resize(chunks);
  trial_.reserve(n);  // so that no step allocates, however many touch
  committed_.reserve(n);
  friction_.reserve(n);
  for (auto& found : found_) found.reserve(chunk_size);
}

void Constraints::open_step(const VecX& x, const VecX& v, const std::vector<double>& masses, double t,
                            double h) {
  prepare(static_cast<int>(x.size() / 3), masses);
  t_ = t;
  h_ = h;
  if (x.size() != x_end_.size() ||
      x != x_end_) {  // a state from elsewhere: what was known of distances says nothing
    std::fill(clearance_.begin(), clearance_.end(), 0.0);
    faces_.look_again();
  }
  x_ = x;
  v_ = v;
  for (MovingBody& body : bodies_) body.begin_step(t, h);
  move_pins();
  if (bodies_.empty()) return;
  for (const Contact& c : trial_) {
    contact_of_[static_cast<std::size_t>(c.particle)] = -1;
    correction_.segment<3>(3 * c.particle).setZero();
  }
  trial_.clear();
}

void Constraints::begin_step(const VecX& x, const VecX& v, const std::vector<double>& masses, double t,
                             double h, bool foresight) {
  open_step(x, v, masses, t, h);
  foresight_ = foresight;
  if (bodies_.empty()) return;
  const int n = static_cast<int>(x.size() / 3);
  parallel_for(chunk_count(n), n < serial_below, [&](int k) {
    auto& found = found_[static_cast<std::size_t>(k)];
    double& deepest = deepest_[static_cast<std::size_t>(k)];
    found.clear();
    deepest = 0;
    for (int i = k * chunk_size; i < std::min(n, (k + 1) * chunk_size); ++i)
      if (!held(i)) look_for_contact(i, found, deepest);
  });
  take_found();
  if (faces_.all().empty()) return;
  x_new_ = x_;
  if (foresight_) x_new_ += h_ * v_;
  faces_.begin_step(bodies_, x_, x_new_, options_.recovery_speed * h_);
  if (!foresight_) faces_.limit_dampers(masses_, h_);
}

void Constraints::take_found() {
  for (const auto& found : found_) {
    for (const Contact& c : found) {
      contact_of_[static_cast<std::size_t>(c.particle)] = static_cast<int>(trial_.size());
      trial_.push_back(c);
      std::array<double, 3> out = {};
      for (int k = 0; k < c.planes; ++k) {
        const auto p = static_cast<std::size_t>(k);
        out[p] = std::clamp(-c.plane[p].gap, 0.0, options_.recovery_speed * h_);
      }
      correction_.segment<3>(3 * c.particle) = along_planes(c, out);
    }
  }
}

void Constraints::look_for_contact(int particle, std::vector<Contact>& found, double& deepest) {
  const Vec3 x = x_.segment<3>(3 * particle), v = v_.segment<3>(3 * particle);
  const int old = committed_of_[static_cast<std::size_t>(particle)];
  const Contact* before = old < 0 ? nullptr : &committed_[static_cast<std::size_t>(old)];
  Contact contact{.particle = particle, .plane = {}};
  for (int o = 0; o < static_cast<int>(bodies_.size()); ++o) {
    const MovingBody& body = bodies_[static_cast<std::size_t>(o)];
    const double margin = body.obstacle().margin;
    const Vec3 x_new = foresight_ ? Vec3(x + h_ * v) : body.carried(x);
    const double travel = body.travel(x, x_new);
    if (clearance(o, particle) > margin + std::max(travel, touching_range(margin))) continue;
    const SurfacePoint start = body.at_start(x);
    clearance(o, particle) = start.distance;
    deepest = std::max(deepest, -start.distance);
    if (start.distance > margin + std::max(travel, touching_range(margin))) continue;
    const ContactPlane plane = body.plane(x, start, x + h_ * v);
    const bool touched = plane_with(before, o) != nullptr;
    if (touched ? plane.gap < touching_range(margin)
                : plane.gap < 0 && plane.gap + body.approach(x, x_new, plane) < 0) {
      add_plane(contact, plane);
    } else if (plane.gap < travel) {
      if (const auto met = body.meeting(x, x_new)) add_plane(contact, *met);
    }
  }
  if (!contact.active()) return;
  start_grip(contact, before);
  found.push_back(contact);
}

bool Constraints::check_paths(const VecX& x_new) {
  if (bodies_.empty()) return false;
  const int n = static_cast<int>(x_new.size() / 3);
  parallel_for(chunk_count(n), n < serial_below, [&](int k) {
    auto& found = found_[static_cast<std::size_t>(k)];
    found.clear();
    for (int i = k * chunk_size; i < std::min(n, (k + 1) * chunk_size); ++i)
      if (!held(i) && contact_of_[static_cast<std::size_t>(i)] < 0)
        look_along_path(i, x_new.segment<3>(3 * i), found);
  });
  const std::size_t before = trial_.size();
  take_found();
  return trial_.size() != before;
}

void Constraints::look_along_path(int particle, const Vec3& x_new, std::vector<Contact>& found) {
  const Vec3 x = x_.segment<3>(3 * particle);
  Contact contact{.particle = particle, .plane = {}};
  for (int o = 0; o < static_cast<int>(bodies_.size()); ++o) {
    const MovingBody& body = bodies_[static_cast<std::size_t>(o)];
    if (clearance(o, particle) > body.obstacle().margin + body.travel(x, x_new)) continue;
    if (const auto met = body.meeting(x, x_new)) add_plane(contact, *met);
  }
  if (!contact.active()) return;
  start_grip(contact, nullptr);
  found.push_back(contact);
}

ContactReport Constraints::end_step(VecX& x_new, VecX& v_new) {
  ContactReport report;
  if (bodies_.empty()) return report;
  const int n = static_cast<int>(x_new.size() / 3);
  parallel_for(chunk_count(n), n < serial_below, [&](int k) {
    int& guarded = guarded_[static_cast<std::size_t>(k)];
    guarded = 0;
    for (int i = k * chunk_size; i < std::min(n, (k + 1) * chunk_size); ++i)
      if (!held(i)) guard(i, x_new, v_new, guarded);
  });
  for (std::size_t k = 0; k < found_.size(); ++k) {
    report.guarded += guarded_[k];
    report.deepest = std::max(report.deepest, deepest_[k]);
  }
  for (const Contact& c : committed_) committed_of_[static_cast<std::size_t>(c.particle)] = -1;
  committed_.clear();
  for (const Contact& c : trial_) {
    if (!c.active()) continue;
    committed_of_[static_cast<std::size_t>(c.particle)] = static_cast<int>(committed_.size());
    committed_.push_back(c);
    if (c.grip == Grip::breaking_loose) committed_.back().grip = Grip::slide;
  }
  faces_.end_step(bodies_, x_, x_new);
  for (MovingBody& body : bodies_)
    if (!body.end_step()) report.converged = false;
  last_h_ = h_;
  x_end_ = x_new;
  report.contacts = static_cast<int>(committed_.size());
  return report;
}

// The last line of defence, outside the equations: no particle that was outside a body ends inside it, or
// behind it; none that was inside ends deeper.
void Constraints::guard(int particle, VecX& x_new, VecX& v_new, int& guarded) {
  const Vec3 x = x_.segment<3>(3 * particle);
  for (int o = 0; o < static_cast<int>(bodies_.size()); ++o) {
    const MovingBody& body = bodies_[static_cast<std::size_t>(o)];
    Vec3 end = x_new.segment<3>(3 * particle);
    const double travel = body.travel(x, end), clear = clearance(o, particle);
    clearance(o, particle) = std::max(0.0, clear - travel);
    if (clear >= travel) continue;
    const auto normal = body.stop(x, end, clear);
    if (!normal) continue;
    x_new.segment<3>(3 * particle) = end;
    const double inward = (v_new.segment<3>(3 * particle) - body.velocity(x)).dot(*normal);
    if (inward < 0) v_new.segment<3>(3 * particle) -= inward * *normal;
    ++guarded;
  }
}

std::vector<double> Constraints::penetration(const VecX& x) const {
  std::vector<double> depth(static_cast<std::size_t>(x.size() / 3), 0.0);
  const int n = static_cast<int>(depth.size());
  for_chunks(n, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      for (const MovingBody& body : bodies_)
        depth[static_cast<std::size_t>(i)] =
            std::max(depth[static_cast<std::size_t>(i)], -body.distance(x.segment<3>(3 * i)));
  });
  return depth;
}

}  // namespace drape
