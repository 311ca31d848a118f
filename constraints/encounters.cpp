#include "constraints/encounters.h"

#include <cmath>
#include <limits>
#include <span>

namespace drape::internal {

void Encounters::spread(const VecX& x, std::vector<Vec3>& places) const {
  for (int i : moving_) places[i] = x.segment<3>(3 * i);
}

void Encounters::set(const std::vector<Triangle>& triangles, const std::vector<std::array<int, 2>>& segments,
                     int particle_count, std::size_t of_cloth, const VecX& x,
                     const std::vector<char>& still) {
  faces_.clear();
  room_ = 0;
  of_cloth_ = 0;
  particles_ = particle_count;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Triangle& t = triangles[k];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    of_cloth_ += of_cloth < triangles.size() && k < of_cloth;
    faces_.push_back({t, {-1, -1, -1}});
  }
  for (const auto& [i, j] : segments) faces_.push_back({{i, j, j}, {-1, -1, -1}});
  boxes_.reset();
  beside_ = {};
  groups_.clear();
  awake_groups_.clear();
  awake_vertices_.clear();
  forget();
  if (faces_.empty()) return;

  const auto particles = static_cast<std::size_t>(particle_count);
  owned_.assign(faces_.size(), 0);
  std::vector<char> has_owner(particles, 0);
  std::vector<std::vector<int>> around(particles), next(particles);
  double length = 0;
  int edges = 0;  // of cloth
  // An edge belongs to its first face.
  FaceSide last = {-1, -1, -1, -1};
  for (const FaceSide& side : sorted_sides(faces_)) {
    const bool is_first = side.low != last.low || side.high != last.high;
    if (is_first && side.low != side.high) owned_[side.face] |= static_cast<unsigned char>(8u << side.side);
    last = side;
  }
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = faces_[f].v[k], w = faces_[f].v[(k + 1) % 3];
      if (v == w) continue;  // the second end of a segment, once more
      around[v].push_back(static_cast<int>(f));
      if (!has_owner[v]) owned_[f] |= static_cast<unsigned char>(1u << k);
      has_owner[v] = 1;
      if ((owned_[f] >> k & 8u) == 0) continue;
      next[v].push_back(w);
      next[w].push_back(v);
      if (of_cloth_ != 0 && static_cast<int>(f) >= of_cloth_) continue;
      length += (x.segment<3>(3 * v) - x.segment<3>(3 * w)).norm();
      ++edges;
    }
  mean_edge_ = length / edges;
  next_start_.assign(1, 0);
  next_.clear();
  for (const std::vector<int>& beside : next) {
    next_.insert(next_.end(), beside.begin(), beside.end());
    next_start_.push_back(static_cast<int>(next_.size()));
  }

  // A pair of triangles belongs to their lowest common vertex.
  beside_start_.assign(1, 0);
  beside_edges_.clear();
  for (int c = 0; c < static_cast<int>(particles); ++c) {
    for (int f : around[c])
      for (int g : around[c])
        if (g > f && of_cloth_ == 0 && common(f, g) == c) list(f, g, beside_.list);
    const auto middle =
        std::partition(beside_.list.begin() + beside_start_.back(), beside_.list.end(), is_of_vertex);
    beside_edges_.push_back(static_cast<int>(middle - beside_.list.begin()));
    beside_start_.push_back(static_cast<int>(beside_.list.size()));
  }
  beside_due_.assign(particles, {at_once, at_once});
  beside_.due.assign(beside_.list.size(), at_once);
  beside_.normal.assign(beside_.list.size(), Vec3::Zero());
  clock_.assign(particles, {});
  asleep_.assign(particles, 0);
  awake_vertices_.reserve(particles);
  limits_.assign(particles, 0);
  start_.clear();
  moving_.clear();
  const auto moves = [&](int i) { return still.empty() || still[i] == 0; };
  for (int i = 0; i < particle_count; ++i) {
    start_.emplace_back(x.segment<3>(3 * i));
    if (moves(i)) moving_.push_back(i);
  }
  end_ = start_;
  boxes_.emplace(faces_, start_, 1, of_cloth_, still);
  unfolded_.reset();
  if (of_cloth_ == 0) {
    join(faces_);
    unfolded_.emplace(faces_, *boxes_, start_);
  }
  patch_start_.assign(1, 0);
  patch_.clear();
  patch_moves_.clear();
  for (const MovingBoxes::Patch& p : boxes_->patches()) {
    const auto first = patch_.size();
    for (int k = p.first; k < p.first + p.count; ++k)
      patch_.insert(patch_.end(), faces_[boxes_->face(k)].v.begin(), faces_[boxes_->face(k)].v.end());
    const auto begin = patch_.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, patch_.end());
    patch_.erase(std::unique(begin, patch_.end()), patch_.end());
    patch_moves_.push_back(std::any_of(begin, patch_.end(), moves));
    patch_start_.push_back(static_cast<int>(patch_.size()));
  }
}

void Encounters::forget() {
  gap_ = -1;
  clocks_are_read_ = false;
  for (Group& g : groups_) g.gap = -1;
  std::fill(beside_.due.begin(), beside_.due.end(), at_once);
  std::fill(beside_due_.begin(), beside_due_.end(), Due{at_once, at_once});
}

// By how much a vector may differ between two patches, or within one, at most, along each axis.
Eigen::Array3d Encounters::difference(const Range& a, const Range& b) {
  return (a.upper - b.lower).max(b.upper - a.lower);
}

double Encounters::largest_difference(const Ranges& ranges) {
  Range all;
  for (const Range& range : ranges) {
    all.lower = all.lower.min(range.lower);
    all.upper = all.upper.max(range.upper);
  }
  return (all.upper - all.lower).maxCoeff();
}

// The ranges of change(vertex).
template <class Change>
void Encounters::measure(const Change& change, Ranges& ranges) const {
  constexpr int patches_at_once = 8;
  const int patches = static_cast<int>(patch_start_.size()) - 1;
  ranges.resize(static_cast<std::size_t>(patches));
  parallel_for((patches + patches_at_once - 1) / patches_at_once, particles_ < serial_below(Work::heavy),
               [&](int chunk) {
                 for (int p = chunk * patches_at_once; p < std::min(patches, (chunk + 1) * patches_at_once);
                      ++p) {
                   if (!patch_moves_[p]) {
                     ranges[p].lower = ranges[p].upper = Eigen::Array3d::Zero();
                     continue;
                   }
                   Range range;
                   for (int k = patch_start_[p]; k < patch_start_[p + 1]; ++k) {
                     const Eigen::Array3d value = change(patch_[k]);
                     range.lower = range.lower.min(value);
                     range.upper = range.upper.max(value);
                   }
                   ranges[p] = range;
                 }
               });
}

bool Encounters::follow(const VecX& x, const VecX& x_new, double gap) {
  clocks_are_read_ = false;
  if (!x.allFinite() || !x_new.allFinite()) return false;
  if (faces_.empty()) return true;
  measure([&](int i) { return Eigen::Array3d(x.segment<3>(3 * i).array() - start_[i].array()); }, of_start_);
  measure([&](int i) { return Eigen::Array3d(x_new.segment<3>(3 * i).array() - end_[i].array()); }, of_end_);
  spread(x, start_);
  spread(x_new, end_);
  for (int k : awake_groups_) {
    Group& g = groups_[k];
    g.start_off += difference(of_start_[g.first], of_start_[g.second]).maxCoeff();
    g.end_off += difference(of_end_[g.first], of_end_[g.second]).maxCoeff();
  }
  start_off_ += largest_difference(of_start_);
  end_off_ += largest_difference(of_end_);
  if (unfolded_) unfolded_->look(start_, end_, gap);
  const bool again = gap > gap_ || std::max(start_off_, end_off_) > grouped_room_;
  if (again) boxes_->refit_patches(patch_start_, patch_, start_, end_);
  const bool listed = (!again || group_patches(gap)) && make_lists(gap, again);
  if (!listed) {
    groups_.clear();
    awake_groups_.clear();
    spare_.clear();
    forget();
  }
  wake_vertices();
  read_clocks(x, x_new);
  clocks_are_read_ = true;
  return listed;
}

void Encounters::wake_vertices() {
  awake_vertices_.clear();
  for (int c = 0; c < static_cast<int>(asleep_.size()); ++c) {
    const bool was_asleep = asleep_[c] != 0;
    asleep_[c] = unfolded_ && unfolded_->is_apart(unfolded_->region_of_vertex(c));
    if (asleep_[c]) continue;
    awake_vertices_.push_back(c);
    if (!was_asleep) continue;
    std::fill(beside_.due.begin() + beside_start_[c], beside_.due.begin() + beside_start_[c + 1], at_once);
    beside_due_[c] = {at_once, at_once};
  }
}

void Encounters::read_clocks(const VecX& x, const VecX& x_new) {
  const auto motion = [&](int i) { return Vec3(x_new.segment<3>(3 * i) - x.segment<3>(3 * i)); };
  measure([&](int i) { return Eigen::Array3d(motion(i).array()); }, of_motion_);
  for (int k : awake_groups_) {
    Group& g = groups_[k];
    g.clock.end = g.clock.start + difference(of_motion_[g.first], of_motion_[g.second]).matrix().norm();
  }
  if (beside_.list.empty()) return;
  for_chunks<Work::heavy>(static_cast<int>(awake_vertices_.size()), [&](int begin, int end) {
    for (int i : std::span(awake_vertices_).subspan(begin, end - begin)) {
      const Vec3 own = motion(i);
      double most = 0;
      for (int k = next_start_[i]; k < next_start_[i + 1]; ++k)
        most = std::max(most, (motion(next_[k]) - own).squaredNorm());
      clock_[i].end = clock_[i].start + 2 * std::sqrt(most);
    }
  });
}

// Where the limits rise, pairs are wanted sooner.
void Encounters::take(const std::vector<double>& limits, double gap) {
  const auto limit = [&](int i) { return std::min(gap, limits[i]); };
  const int patches = static_cast<int>(patch_start_.size()) - 1;
  rises_.assign(static_cast<std::size_t>(patches), 0);
  for_chunks<Work::heavy>(patches, [&](int begin, int end) {
    for (int p = begin; p < end; ++p)
      for (int k = patch_start_[p]; k < patch_start_[p + 1]; ++k)
        rises_[p] = std::max(rises_[p], limit(patch_[k]) - limits_[patch_[k]]);
  });
  for (int k : awake_groups_)
    groups_[k].wanted -= std::max(rises_[groups_[k].first], rises_[groups_[k].second]);
  for (int i = 0; i < static_cast<int>(limits_.size()); ++i) limits_[i] = limit(i);
}

void Encounters::went(const VecX& x, const VecX& x_new) {
  if (faces_.empty()) return;
  const bool followed = clocks_are_read_ && std::all_of(moving_.begin(), moving_.end(), [&](int i) {
                          return x.segment<3>(3 * i) == start_[i] && x_new.segment<3>(3 * i) == end_[i];
                        });
  if (!followed) read_clocks(x, x_new);
  clocks_are_read_ = false;
  for (int k : awake_groups_) groups_[k].clock.start = groups_[k].clock.end;
  for (int c : awake_vertices_) clock_[c].start = clock_[c].end;
}

}  // namespace drape::internal
