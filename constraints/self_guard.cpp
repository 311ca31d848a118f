// The guard of constraints/self_contact.h: nothing passes through anything on the way to the end of a step.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "constraints/encounters.h"
#include "constraints/self_contact.h"
#include "constraints/surfaces.h"
#include "constraints/tangles.h"

namespace drape {

using namespace internal;

namespace {

// What fails is pushed apart in so many rounds at most. What still fails is stopped: so often the way of a
// particle is shortened by shares, and then given up. After so many rounds what is stopped has no way in
// common any more, and after the last round whole pieces stand still.
constexpr int rounds_of_pushes = 40, stops_by_shares = 8, rounds_in_common = 40, most_rounds = 64;

}  // namespace

std::vector<Meeting>& SelfContacts::meetings(const VecX& x, const VecX& x_new) {
  const double floor = floor_of(x, x_new);
  const auto look = [&](const Encounter& e, const FourPoints& start, const FourPoints& end,
                        const Vec3& likely) {
    if (may_pass(e)) return Approach{};
    const Approach found = approach_from_within(e.edges, start, end, floor, likely);
    if (found.touching)
      std::atomic_ref(is_on_body(e) ? touched_body_ : touched_).store(1, std::memory_order_relaxed);
    return found;
  };
  const auto gap_of = [floor](const Encounter&) { return floor; };
  std::swap(found_, encounters_->select(Encounters::Kind::both, x, x_new, floor, gap_of, look));
  if (surfaces_->any()) {
    const std::vector<Meeting>& others =
        on_bodies_->select(Encounters::Kind::both, x, x_new, floor, gap_of, look);
    found_.insert(found_.end(), others.begin(), others.end());
  }
  return found_;
}

bool SelfContacts::meet(const VecX& of_cloth) {
  if (!any()) return false;
  const StepMotion& step = surfaces_->step();
  const VecX& x_new = surfaces_->with(of_cloth);
  if (!follow_all(step.x, x_new)) return false;
  const auto before = touching_.size();
  met_.clear();
  const std::vector<Meeting>& met = meetings(step.x, x_new);
  is_proven_ = met.empty();
  if (is_proven_) proven_ = of_cloth;
  const auto by_pair = [](const SelfContact& a, const Encounter& who) { return a.who < who; };
  bool stiffer = false;
  for (const Meeting& meeting : met) {
    const auto known = std::lower_bound(touching_.begin(), touching_.end(), meeting.who, by_pair);
    if (known != touching_.end() && known->who == meeting.who) {
      stiffer = stiffen_to_hold(*known, x_new) || stiffer;
      continue;
    }
    if (const auto contact = contact_of(step, meeting.who, meeting.approach.last)) met_.push_back(*contact);
  }
  for (SelfContact& contact : met_) {
    contact.active = true;
    contact.share = 0;
    contact.now = contact.at(x_new);
    touching_.push_back(contact);
  }
  if (touching_.size() == before && !stiffer) return false;
  accepted_ = false;
  sort_touching();
  for (const SelfContact& found : met_) {
    SelfContact& contact = *std::lower_bound(touching_.begin(), touching_.end(), found.who, by_pair);
    go_on(contact, step, recovery_);
  }
  return true;
}

int SelfContacts::zone_of(int particle) {
  while (zone_[particle] != particle) particle = zone_[particle] = zone_[zone_[particle]];
  return particle;
}

// The ways in common, by zone. A zone goes with the body that is in it, or stands where several are, or
// particles that are held otherwise; or with its particles that are held, if there are any and they go the
// same way (else it stands); or the mean way of those that touch a body; or else of all by mass. A zone of
// the last kind keeps its mean, so no momentum is lost.
void SelfContacts::find_common(const StepMotion& step, const VecX& x_new, bool in_common) {
  const int n = static_cast<int>(zone_.size());
  const auto way = [&](int i) { return Vec3(x_new.segment<3>(3 * i) - step.x.segment<3>(3 * i)); };
  const auto hold_on = [&](int i) { return step.is_held(i) ? Held::yes : hold_[i]; };
  const auto weight = [&](int i) {
    const Held of_zone = zone_hold_[zone_of(i)];
    return hold_on(i) != of_zone ? 0.0 : of_zone == Held::no ? step.mass(i) : 1.0;
  };
  zone_body_.assign(zone_.size(), no_body);
  body_way_.assign(zone_.size(), Vec3::Zero());
  weight_.assign(zone_.size(), 0);
  for (int i = cloth_particles(); i < n; ++i) {
    const int zone = zone_of(i);
    int& body = zone_body_[zone];
    body = body == no_body || body == surfaces_->body_of(i) ? surfaces_->body_of(i) : several;
    body_way_[zone] += way(i);
    ++weight_[zone];
  }
  for (int i = 0; i < n; ++i)
    if (weight_[i] > 0) body_way_[i] /= weight_[i];
  for (int i = 0; i < cloth_particles(); ++i) {
    const int zone = zone_of(i);
    if (!step.is_held(i) || zone_body_[zone] == no_body) continue;
    const double otherwise = (way(i) - way_with_body(i, step)).norm();
    if (otherwise > 1e-9 + 1e-3 * way(i).norm()) zone_body_[zone] = several;
  }
  common_.assign(zone_.size(), Vec3::Zero());
  weight_.assign(zone_.size(), 0);
  zone_hold_.assign(zone_.size(), Held::no);
  for (int i = 0; i < n; ++i) zone_hold_[zone_of(i)] = std::max(zone_hold_[zone_of(i)], hold_on(i));
  for (int i = 0; i < n; ++i) {
    common_[zone_of(i)] += weight(i) * way(i);
    weight_[zone_of(i)] += weight(i);
  }
  for (int i = 0; i < n; ++i) {
    if (weight_[i] > 0) common_[i] /= weight_[i];
  }
  for (int i = n; i-- > 0;)  // the first one's exactly, not a mean that is rounded
    if (step.is_held(i)) common_[zone_of(i)] = way(i);
  for (int i = 0; i < n; ++i)
    if (!in_common || (step.is_held(i) && way(i) != common_[zone_of(i)])) common_[zone_of(i)].setZero();
  kept_ = common_;
  for (int i = 0; i < n; ++i) {
    const int zone = zone_of(i);
    if (in_common && zone_hold_[zone] == Held::no && weight_[zone] > 0)
      kept_[zone] -= weight(i) / weight_[zone] * share_of(i) * (way(i) - common_[zone]);
  }
}

// The way of a particle that goes with the body of its zone: as that turns, or, where it deforms, by the mean
// of what it has there.
Vec3 SelfContacts::way_with_body(int particle, const StepMotion& step) {
  const int zone = zone_of(particle), body = zone_body_[zone];
  if (body == several) return Vec3::Zero();
  const MovingBody& moving = (*bodies_)[body];
  const Vec3 place = step.place(particle);
  return deforming(moving.obstacle().shape) ? body_way_[zone] : Vec3(moving.carried(place) - place);
}

// Sets ahead_ to where the particles come that go the shares way_ of their ways. A tangle that is still has
// nothing but the way in common, and its relief.
void SelfContacts::go_shares(const StepMotion& step, const VecX& x_new, bool in_common) {
  find_common(step, x_new, in_common);
  for (int i = 0; i < cloth_particles(); ++i) {
    if (way_[i] == 1 && still_[i] == 0) continue;
    const int zone = zone_of(i), body = zone_body_[zone];
    Vec3 common = common_[zone], kept = kept_[zone];
    const Vec3 way = x_new.segment<3>(3 * i) - step.x.segment<3>(3 * i);
    if (body != no_body) common = kept = step.is_held(i) ? way : way_with_body(i, step);
    ahead_.segment<3>(3 * i) =
        step.x.segment<3>(3 * i) + kept + share_of(i) * (way - common) + way_[i] * relief_.segment<3>(3 * i);
  }
}

// Joins the particles of the pairs to zones, and shortens the way of each against that of its zone.
void SelfContacts::stop(const std::vector<Meeting>& failing, const StepMotion& step, const VecX& x_new,
                        bool in_common) {
  shorter_ = way_;
  for (const Meeting& meeting : failing)
    for (int v : meeting.who.v) {
      zone_[zone_of(v)] = zone_of(meeting.who.v[0]);
      if (v >= cloth_particles()) continue;
      const bool by_shares = stops_[v] < stops_by_shares;
      shorter_[v] = std::min(shorter_[v], by_shares ? 0.9 * meeting.approach.until * way_[v] : 0.0);
    }
  for (std::size_t i = 0; i < way_.size(); ++i) stops_[i] += shorter_[i] < way_[i];
  way_ = shorter_;
  go_shares(step, x_new, in_common);
}

// Whether a push this way leads the particle into no body that it touches. What two bodies clamp cannot go
// anywhere.
bool SelfContacts::may_leave(int particle, const Vec3& push) const {
  if (hold_[particle] == Held::no) return true;
  const Contact& contact = *touches_[particle];
  return !contact.clamped &&
         std::all_of(contact.plane.begin(), contact.plane.begin() + contact.planes,
                     [&](const ContactPlane& plane) { return plane.normal.dot(push) >= 0; });
}

// Pushes the sides of these pairs apart along their normals, by impulses, which keep the momentum: to a tenth
// of what was between them at the start. A pair that ends farther apart than that met something on its way,
// and goes half as far again. Skips a pair of which a particle would come farther than it is thick from where
// it wanted to go, or was stopped, or is moved by its relief, which no velocity may come from; and a pair of
// which neither side can move. Returns whether it pushed any.
bool SelfContacts::push_apart(const std::vector<Meeting>& failing, const StepMotion& step) {
  constexpr double share = 0.1;
  const double floor = floor_of(step.x, ahead_);
  bool any = false;
  for (const Meeting& meeting : failing) {
    const Encounter& e = meeting.who;
    const FourPoints end = corners(ahead_, e);
    const Approach now = approach_from_within(e.edges, corners(step.x, e), end, floor);
    if (now.apart) continue;  // since a pair before it was pushed
    const Vec3& n = now.last.normal;
    const std::array<double, 4>& w = now.last.weights;
    std::array<double, 4> moves{};  // w_k / m_k
    double gap = 0, inverse = 0;    // 1/m
    bool skip = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const int v = e.v[k];
      gap += w[k] * n.dot(end[k]);
      skip = skip || way_[v] < 1 || still_[v] != 0 || !relief_.segment<3>(3 * v).isZero(0);
      if (step.is_held(v) || !(step.mass(v) > 0) || !may_leave(v, w[k] * n)) continue;
      moves[k] = w[k] / step.mass(v);
      inverse += w[k] * moves[k];
    }
    const double most = both_thicknesses(e), asked = share * std::min(now.start, most);
    const double impulse = std::max({asked - gap, 0.5 * asked, 0.5 * gap}) / inverse;  // kg m
    for (std::size_t k = 0; k < 4; ++k)
      skip = skip || !((push_.segment<3>(3 * e.v[k]) + impulse * moves[k] * n).norm() < most);
    if (skip || !(inverse > 0)) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 push = impulse * moves[k] * n;
      for (VecX* places : {&push_, &wanted_, &ahead_}) places->segment<3>(3 * e.v[k]) += push;
    }
    any = true;
  }
  return any;
}

// Lets the cloth pass the bodies where it fails; false when all that fails is between cloth and cloth.
bool SelfContacts::let_bodies_yield(const std::vector<Meeting>& failing) {
  bool yielded = false;
  for (const Meeting& meeting : failing) {
    if (!is_on_body(meeting.who)) continue;
    for (int v : meeting.who.v) {
      if (v >= cloth_particles()) continue;
      surfaces_->pinch(v);
      yielded = true;
    }
  }
  return yielded;
}

// Joins the particles of each of these tangles to a zone, in which they move as a whole, but for their
// relief; and without it where that did not help.
void SelfContacts::stop_tangles(const std::vector<int>& tangles) {
  for (int i = 0; i < cloth_particles(); ++i) {
    if (!std::binary_search(tangles.begin(), tangles.end(), tangles_->tangle(i))) continue;
    if (still_[i] != 0) way_[i] = 0;
    still_[i] = 1;
    zone_[zone_of(i)] = zone_of(tangles_->tangle(i));
  }
}

// Sets relief_, which leads nothing into a body that it touches.
void SelfContacts::find_relief(const StepMotion& step, const std::vector<Contact>& on_bodies) {
  relief_ = tangles_->relief(step, recovery_);
  for (const Contact& contact : on_bodies)
    for (int k = 0; k < contact.planes; ++k) {
      auto relief = relief_.segment<3>(3 * contact.particle);
      const Vec3& n = contact.plane[k].normal;
      relief -= std::min(0.0, n.dot(relief)) * n;
    }
}

// Pushes apart, and then shortens the ways, until nothing meets and no more triangles cross than may; ahead_
// is then where they end. x_new has to be wanted_, which the pushes change.
void SelfContacts::shorten(const StepMotion& step, const VecX& x_new, bool in_common) {
  int pushes_left = in_common ? rounds_of_pushes : 0;
  for (int round = 0; round <= most_rounds && follow_all(step.x, ahead_); ++round) {
    const bool together = in_common && round < rounds_in_common;
    const std::vector<Meeting>& failing = meetings(step.x, ahead_);
    if (!failing.empty()) {
      if (pushes_left > 0 && push_apart(failing, step)) {
        --pushes_left;
        --round;
        continue;
      }
      pushes_left = 0;
      if (round >= rounds_in_common && let_bodies_yield(failing)) {
        --round;  // fewer particles can be pinched every time
        continue;
      }
      stop(failing, step, x_new, together);
      continue;
    }
    if (!crossing()) return;
    const std::vector<int>& growing = tangles_->growing(ahead_);
    if (growing.empty()) return;
    stop_tangles(growing);
    go_shares(step, x_new, together);
  }
  let_pieces_stand(step);
}

// Leaves the pieces to which what still fails belongs where they began; and the one that goes farthest where
// so much is near that there is no list of what fails. Other pieces go on, unless they meet these.
void SelfContacts::let_pieces_stand(const StepMotion& step) {
  std::vector<char> stands(way_.size(), 0);  // by piece_to_stand_
  while (!pieces_part(step, stands)) {
  }
  for (int i = 0; i < cloth_particles(); ++i) stood_still_ += is_marked(stands, i);
}

// True when nothing fails, or nothing more can stand; else more pieces stand than before.
bool SelfContacts::pieces_part(const StepMotion& step, std::vector<char>& stands) {
  if (!follow_all(step.x, ahead_)) {
    mark_farthest(step, stands);
    return !stand_still(step, stands);
  }
  const std::vector<Meeting>& failing = meetings(step.x, ahead_);
  const auto mark = [&](int v) {
    if (piece_to_stand_[v] >= 0) stands[piece_to_stand_[v]] = 1;
  };
  for (const Meeting& meeting : failing)
    for (const int v : meeting.who.v)
      if (v < cloth_particles()) mark(v);
  bool passes = failing.empty();
  if (passes && crossing()) {
    const std::vector<int>& growing = tangles_->growing(ahead_);
    passes = growing.empty();
    for (int i = 0; i < cloth_particles() && !passes; ++i)
      if (std::ranges::binary_search(growing, tangles_->tangle(i))) mark(i);
  }
  return passes || (!stand_still(step, stands) && !let_bodies_yield(failing));
}

bool SelfContacts::is_marked(const std::vector<char>& pieces, int particle) const {
  return piece_to_stand_[particle] >= 0 && pieces[piece_to_stand_[particle]] != 0;
}

// Marks the piece with the particle that goes farthest.
void SelfContacts::mark_farthest(const StepMotion& step, std::vector<char>& pieces) const {
  double most = 0;
  int farthest = -1;
  for (int i = 0; i < cloth_particles(); ++i) {
    const double way = (ahead_.segment<3>(3 * i) - step.x.segment<3>(3 * i)).squaredNorm();
    if (piece_to_stand_[i] >= 0 && way > most) most = way, farthest = i;
  }
  if (farthest >= 0) pieces[piece_to_stand_[farthest]] = 1;
}

// Returns whether any particle of these pieces had a way left.
bool SelfContacts::stand_still(const StepMotion& step, const std::vector<char>& pieces) {
  bool any = false;
  for (int i = 0; i < cloth_particles(); ++i) {
    if (!is_marked(pieces, i) || ahead_.segment<3>(3 * i) == step.x.segment<3>(3 * i)) continue;
    way_[i] = 0;
    ahead_.segment<3>(3 * i) = step.x.segment<3>(3 * i);
    any = true;
  }
  return any;
}

// Takes the particles to ahead_, and changes their velocity by what changes of their way; relief is none of
// it. The second guard of a step finds the relief of the first one in x_new.
GuardReport SelfContacts::go_ahead(const StepMotion& step, bool first, VecX& x_new, VecX& v_new) {
  GuardReport report;
  report.stood_still = stood_still_;
  if (first) given_.setZero(x_new.size());
  for (std::size_t i = 0; i < static_cast<std::size_t>(cloth_particles()); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const Vec3 relief = way_[i] * relief_.segment<3>(k);
    const bool loses_way = way_[i] < 1 || still_[i] != 0;
    if (loses_way || !push_.segment<3>(k).isZero(0)) {
      const Vec3 kept = x_new.segment<3>(k) - (still_[i] != 0 ? 1 : 1 - way_[i]) * given_.segment<3>(k);
      v_new.segment<3>(k) -= (kept + relief - ahead_.segment<3>(k)) / step.h;
      ++report.guarded;
      report.held += !loses_way;
      stopped_[i] = 1;
    }
    if (first) given_.segment<3>(k) = relief;
    x_new.segment<3>(k) = ahead_.segment<3>(k);
  }
  return report;
}

GuardReport SelfContacts::guard(const std::vector<MovingBody>& bodies, const std::vector<Contact>& on_bodies,
                                bool in_common, VecX& x_new, VecX& v_new) {
  stood_still_ = 0;
  if (!any() || (is_proven_ && !crossing() && x_new == proven_) || !x_new.allFinite()) return {};
  const StepMotion& step = surfaces_->step();
  bodies_ = &bodies;
  hold_.assign(way_.size(), Held::no);
  touches_.assign(way_.size(), nullptr);
  for (const Contact& contact : on_bodies) {
    if (!contact.active()) continue;
    hold_[contact.particle] = Held::by_body;
    touches_[contact.particle] = &contact;
  }
  std::fill(way_.begin(), way_.end(), 1.0);
  stops_.assign(way_.size(), 0);
  still_.assign(way_.size(), 0);
  zone_.resize(way_.size());
  std::iota(zone_.begin(), zone_.end(), 0);
  relief_.setZero(step.x.size());
  push_.setZero(step.x.size());
  if (crossing() && in_common) find_relief(step, on_bodies);
  wanted_ = surfaces_->with(x_new);
  ahead_ = wanted_ + relief_;
  shorten(step, wanted_, in_common);
  return go_ahead(step, in_common, x_new, v_new);
}

}  // namespace drape
