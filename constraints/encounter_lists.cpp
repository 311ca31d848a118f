// How constraints/encounters.h lists the pairs of every two patches that come near each other.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "constraints/encounters.h"

namespace drape::internal {
namespace {

// How far the motions of two patches may come to differ from those that were searched, as a share of an edge.
constexpr double most_room = 0.4, least_room = 0.04;
// So many pairs of two patches there may be for each of their triangles, and so many of all for each
// triangle, before this is made less: all lists are gone through in every step.
constexpr std::size_t most_pairs = 32, most_of_all = 64;
// Cloth has exploded where there are more pairs for a vertex than this, or more patches near each patch.
constexpr std::size_t exploded = 2000, most_groups = 1000;

}  // namespace

void Encounters::list(int first, int second, std::vector<Encounter>& found) const {
  const Triangle &s = faces_[first].v, &t = faces_[second].v;
  const auto has = [](const Triangle& triangle, int v) {
    return std::find(triangle.begin(), triangle.end(), v) != triangle.end();
  };
  for (std::size_t k = 0; k < 3; ++k) {
    if (of_cloth_ == 0 && (owned_[first] >> k & 1u) != 0 && !has(t, s[k]))
      found.push_back({.v = {s[k], t[0], t[1], t[2]}, .edges = false});
    if ((owned_[second] >> k & 1u) != 0 && !has(s, t[k]))
      found.push_back({.v = {t[k], s[0], s[1], s[2]}, .edges = false});
  }
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l) {
      if ((owned_[first] >> k & 8u) == 0 || (owned_[second] >> l & 8u) == 0) continue;
      const int a = s[k], b = s[(k + 1) % 3], c = t[l], d = t[(l + 1) % 3];
      if (a == c || a == d || b == c || b == d) continue;
      found.push_back({.v = {std::min(a, b), std::max(a, b), std::min(c, d), std::max(c, d)}, .edges = true});
    }
}

int Encounters::common(int first, int second) const {
  int lowest = -1;
  for (int v : faces_[first].v)
    for (int w : faces_[second].v)
      if (v == w && (lowest < 0 || v < lowest)) lowest = v;
  return lowest;
}

// The box of the corners [from, to) of a pair.
Encounters::Box Encounters::box_about(const Encounter& e, std::size_t from, std::size_t to) const {
  Box box;
  for (std::size_t s = 0; s < 2; ++s) {
    const std::vector<Vec3>& at = s == 0 ? start_ : end_;
    box.lower[s] = box.upper[s] = at[e.v[from]].array();
    for (std::size_t k = from + 1; k < to; ++k) {
      box.lower[s] = box.lower[s].min(at[e.v[k]].array());
      box.upper[s] = box.upper[s].max(at[e.v[k]].array());
    }
  }
  return box;
}

// Whether the boxes are nearer than `reach` along all axes at a common time.
bool Encounters::touch(const Box& a, const Box& b, double reach) const {
  double enter = 0, leave = 1;
  const auto keep = [&](double at_0, double at_1) {
    if (at_0 < 0 && at_1 < 0) leave = -1;
    if (at_0 < 0 && at_1 >= 0) enter = std::max(enter, at_0 / (at_0 - at_1));
    if (at_0 >= 0 && at_1 < 0) leave = std::min(leave, at_0 / (at_0 - at_1));
  };
  for (int k = 0; k < 3; ++k) {
    keep(a.upper[0][k] - b.lower[0][k] + reach, a.upper[1][k] - b.lower[1][k] + reach);
    keep(b.upper[0][k] - a.lower[0][k] + reach, b.upper[1][k] - a.lower[1][k] + reach);
  }
  return enter <= leave + 1e-9;
}

// Whether the two stay apart along the normal of the first triangle at the start, so far that no motion
// brings them within `reach` that differs from this one by no more along each axis. Along a fixed direction
// the distance of two triangles whose corners go straight is a concave function of time, so it is least at
// one of the ends. Boxes do not tell layers apart that lie on a slope.
bool Encounters::apart_along_normal(int first, int second, double reach) const {
  const Triangle &a = faces_[first].v, &b = faces_[second].v;
  const Vec3 n = (start_[a[1]] - start_[a[0]]).cross(start_[a[2]] - start_[a[0]]);
  const double enough = reach * n.lpNorm<1>();  // a change by 1 along each axis is |n|_1 along n
  bool above = true, below = true;
  for (const std::vector<Vec3>* x : {&start_, &end_}) {
    const auto [a_low, a_high] = std::minmax({n.dot((*x)[a[0]]), n.dot((*x)[a[1]]), n.dot((*x)[a[2]])});
    const auto [b_low, b_high] = std::minmax({n.dot((*x)[b[0]]), n.dot((*x)[b[1]]), n.dot((*x)[b[2]])});
    above = above && b_low - a_high > enough;
    below = below && a_low - b_high > enough;
  }
  return above || below;
}

// Groups the patches that come near each other; what is known of those that were already is kept. False: so
// many do that the cloth must have exploded.
bool Encounters::group_patches(double gap) {
  if (room_ <= 0) room_ = most_room * mean_edge_;
  near_.clear();
  const std::size_t most = most_groups * boxes_->patches().size();
  const auto add = [&](int p, int q) {
    near_.emplace_back(p, q);
    return near_.size() <= most;
  };
  if (!boxes_->near_patches(add, gap + room_)) return false;
  std::sort(near_.begin(), near_.end());
  std::swap(groups_, old_);
  groups_.clear();
  auto old = old_.begin();
  const auto patches = [](const Group& g) { return std::pair(g.first, g.second); };
  for (const auto& pair : near_) {
    for (; old != old_.end() && patches(*old) < pair; ++old) spare_.push_back(std::move(*old));
    if (old != old_.end() && patches(*old) == pair) {
      groups_.push_back(std::move(*old++));
      continue;
    }
    if (spare_.empty()) spare_.emplace_back();
    groups_.push_back(std::move(spare_.back()));
    spare_.pop_back();
    Group& g = groups_.back();
    g.first = pair.first, g.second = pair.second;
    g.gap = -1, g.room = 0;
    g.region = unfolded_ ? unfolded_->region_of(g.first, g.second) : -1;
    g.pairs.list.clear();
  }
  std::move(old, old_.end(), std::back_inserter(spare_));
  gap_ = gap;
  grouped_room_ = room_;
  start_off_ = end_off_ = 0;
  return true;
}

// Lists the pairs of groups whose list does not cover the motion. False: there are so many pairs that the
// cloth must have exploded.
bool Encounters::make_lists(double gap, bool fitted) {
  const std::size_t most = exploded * start_.size();
  std::size_t kept = 0;
  stale_.clear();
  awake_groups_.clear();
  for (int k = 0; k < static_cast<int>(groups_.size()); ++k) {
    Group& g = groups_[k];
    if (unfolded_ && unfolded_->is_apart(g.region)) {
      g.gap = -1;
      continue;
    }
    awake_groups_.push_back(k);
    if (g.gap < gap || std::max(g.start_off, g.end_off) > g.room)
      stale_.push_back(k);
    else
      kept += g.pairs.list.size();
  }
  if (!stale_.empty() && !fitted) boxes_->refit_patches(patch_start_, patch_, start_, end_);
  fit_stale_patches();
  std::atomic<std::size_t> count = kept;
  parallel_for(static_cast<int>(stale_.size()), particles_ < serial_below(Work::heavy), [&](int k) {
    if (count > most) return;
    Group& g = groups_[stale_[k]];
    make_list(g, gap);
    count += g.pairs.list.size();
  });
  if (count > most) return false;
  adapt_room(count);
  return true;
}

// Fits the boxes within the patches of which pairs will be listed.
void Encounters::fit_stale_patches() {
  patch_is_stale_.assign(boxes_->patches().size(), 0);
  for (int k : stale_) patch_is_stale_[groups_[k].first] = patch_is_stale_[groups_[k].second] = 1;
  for_chunks<Work::heavy>(static_cast<int>(patch_is_stale_.size()), [&](int begin, int end) {
    for (int p = begin; p < end; ++p)
      if (patch_is_stale_[p]) boxes_->refit_within(p, faces_, start_, end_);
  });
}

// Where there are too many pairs, the lists that look too far ahead are made anew for the next motion. Where
// there are few, those that are made later look farther ahead.
void Encounters::adapt_room(std::size_t pairs) {
  const double least = least_room * mean_edge_;
  if (pairs > most_of_all * faces_.size() && room_ > least) {
    room_ = std::max(0.5 * room_, least);
    gap_ = -1;
    for (Group& g : groups_)
      if (g.room > room_) g.gap = -1;
  } else if (8 * pairs < most_of_all * faces_.size()) {
    room_ = std::min(2 * room_, most_room * mean_edge_);
  }
}

// A list that would become long is made with less room, for it is gone through in every step.
void Encounters::make_list(Group& group, double gap) const {
  const auto count = [&](int patch) { return static_cast<std::size_t>(boxes_->patches()[patch].count); };
  const std::size_t most = most_pairs * (count(group.first) + count(group.second));
  const double least = least_room * mean_edge_;
  if (group.room <= 0)
    group.room = room_;
  else if (group.pairs.list.size() < most / 4)
    group.room = 2 * group.room;
  group.room = std::min(group.room, room_);
  while (
      !search(group, gap + group.room, group.room > least ? most : std::numeric_limits<std::size_t>::max()))
    group.room *= 0.5;
  Pairs& pairs = group.pairs;
  group.edges_from = static_cast<int>(std::partition(pairs.list.begin(), pairs.list.end(), is_of_vertex) -
                                      pairs.list.begin());
  pairs.due.assign(pairs.list.size(), at_once);
  pairs.normal.assign(pairs.list.size(), Vec3::Zero());
  group.gap = gap;
  group.clock = {};
  group.due = {at_once, at_once};
  group.wanted = at_once;
  group.start_off = group.end_off = 0;
}

// Lists the pairs of a group that come within this distance. False: they are more than `most`.
bool Encounters::search(Group& group, double within, std::size_t most) const {
  std::vector<Encounter>& found = group.pairs.list;
  found.clear();
  return boxes_->pairs_of_patches(
      group.first, group.second,
      [&](int first, int second) {
        if (common(first, second) >= 0) return true;
        if (of_cloth_ != 0 && (first < of_cloth_) == (second < of_cloth_)) return true;
        if (apart_along_normal(first, second, within)) return true;
        const auto before = static_cast<std::ptrdiff_t>(found.size());
        list(std::min(first, second), std::max(first, second), found);
        const auto far = [&](const Encounter& e) {
          const std::size_t cut = e.edges ? 2 : 1;
          return !touch(box_about(e, 0, cut), box_about(e, cut, 4), within);
        };
        found.erase(std::remove_if(found.begin() + before, found.end(), far), found.end());
        return found.size() <= most;
      },
      within);
}

}  // namespace drape::internal
