// The guard of constraints/self_contact.h: nothing passes through anything on the way to the end of a step.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "constraints/encounters.h"
#include "constraints/self_contact.h"

namespace drape {

using namespace internal;

namespace {

constexpr int most_rounds = 8;  // in which ways are shortened by shares; after them they are given up

// No two things come nearer than this [m]: places that are written as floats then do not cross, either.
double floor_of(const VecX& x, const VecX& x_new) {
  const double largest = std::max(x.lpNorm<Eigen::Infinity>(), x_new.lpNorm<Eigen::Infinity>());
  return 4 * std::sqrt(3.0) * std::ldexp(largest, -24);
}

}  // namespace

std::vector<Meeting>& SelfContacts::meetings(const VecX& x, const VecX& x_new) {
  const double floor = floor_of(x, x_new);
  return encounters_->select(
      x, x_new, floor,
      [&](const Encounter& e, const FourPoints& start, const FourPoints& end, const Vec3& likely) {
        if (exempt(e)) return Approach{};
        const Approach found = approach_from_within(e.edges, start, end, floor, likely);
        if (found.touching) std::atomic_ref(touched_).store(1, std::memory_order_relaxed);
        return found;
      });
}

bool SelfContacts::meet(const StepMotion& step, const VecX& x_new) {
  if (!any() || !encounters_->follow(step.x, x_new, reach_)) return false;
  const auto before = touching_.size();
  const std::vector<Meeting>& met = meetings(step.x, x_new);
  is_proven_ = met.empty();
  if (is_proven_) proven_ = x_new;
  for (const Meeting& meeting : met) {
    if (has_contact(meeting.who)) continue;
    if (const auto contact = contact_of(step, meeting.who, meeting.approach.last)) met_.push_back(*contact);
  }
  for (SelfContact& contact : met_) {
    contact.active = true;
    contact.share = 0;
    contact.now = contact.at(x_new);
    touching_.push_back(contact);
  }
  met_.clear();
  if (touching_.size() == before) return false;
  accepted_ = false;
  std::sort(touching_.begin(), touching_.end(),
            [](const SelfContact& a, const SelfContact& b) { return a.who < b.who; });
  return true;
}

int SelfContacts::guard(const StepMotion& step, VecX& x_new, VecX& v_new) {
  if (!any() || (is_proven_ && x_new == proven_) || !x_new.allFinite()) return 0;
  int stopped = 0;
  std::fill(way_.begin(), way_.end(), 1.0);
  ahead_ = x_new;
  for (int round = 0;; ++round) {
    if (round > 2 * most_rounds || !encounters_->follow(step.x, ahead_, reach_)) {  // then nothing moves
      std::fill(way_.begin(), way_.end(), 0.0);
      ahead_ = step.x;
      break;
    }
    const std::vector<Meeting>& failing = meetings(step.x, ahead_);
    if (failing.empty()) break;
    shorter_ = way_;
    for (const Meeting& meeting : failing)
      for (int v : meeting.who.v)
        shorter_[v] =
            std::min(shorter_[v], round < most_rounds ? 0.9 * meeting.approach.until * way_[v] : 0.0);
    way_ = shorter_;
    for (std::size_t i = 0; i < way_.size(); ++i) {
      const auto k = 3 * static_cast<Eigen::Index>(i);
      if (way_[i] == 0)
        ahead_.segment<3>(k) = step.x.segment<3>(k);
      else if (way_[i] < 1)
        ahead_.segment<3>(k) = step.x.segment<3>(k) + way_[i] * (x_new.segment<3>(k) - step.x.segment<3>(k));
    }
  }
  for (std::size_t i = 0; i < way_.size(); ++i) {
    if (way_[i] == 1) continue;
    const auto k = 3 * static_cast<Eigen::Index>(i);
    v_new.segment<3>(k) -= (x_new.segment<3>(k) - ahead_.segment<3>(k)) / step.h;
    x_new.segment<3>(k) = ahead_.segment<3>(k);
    ++stopped;
  }
  return stopped;
}

}  // namespace drape
