#include "constraints/encounters.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <map>

namespace drape::internal {
namespace {

// How far a motion may be from the one that was searched, as shares of an edge, and how many pairs there may be for
// each vertex before this is made less.
constexpr double most_room = 0.2, least_room = 0.02;
constexpr std::size_t most_pairs = 40, exploded = 50;

constexpr double never = -std::numeric_limits<double>::infinity();

Vec3 place(const VecX& x, std::size_t particle) {
  return x.segment<3>(3 * static_cast<Eigen::Index>(particle));
}

struct Sum {
  Vec3 value = Vec3::Zero();
  Sum& operator+=(const Sum& other) {
    value += other.value;
    return *this;
  }
};

// The mean of f(i) for i < n.
template <class F>
Vec3 mean(int n, const F& f) {
  return sum_chunks(n,
                    [&](int begin, int end) {
                      Sum sum;
                      for (int i = begin; i < end; ++i) sum.value += f(i);
                      return sum;
                    })
             .value /
         n;
}

struct Largest {
  double value = 0;
  Largest& operator+=(const Largest& other) {
    value = std::max(value, other.value);
    return *this;
  }
};

// The largest of f(i) for i < n; infinite where one is no number.
template <class F>
double largest(int n, const F& f) {
  return sum_chunks(n,
                    [&](int begin, int end) {
                      Largest most;
                      for (int i = begin; i < end; ++i) {
                        const double value = f(i);
                        most += {value == value ? value : std::numeric_limits<double>::infinity()};
                      }
                      return most;
                    })
      .value;
}

}  // namespace

void Encounters::spread(const VecX& x, std::vector<Vec3>& places) const {
  places.resize(static_cast<std::size_t>(particles_));
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = place(x, i);
}

void Encounters::set(const std::vector<Triangle>& triangles, int particle_count, std::size_t of_cloth,
                     const VecX& x) {
  faces_.clear();
  of_cloth_ = 0;
  particles_ = particle_count;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Triangle& t = triangles[k];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    of_cloth_ += of_cloth < triangles.size() && k < of_cloth;
    faces_.push_back({t, {-1, -1, -1}});
  }
  boxes_.reset();
  beside_ = near_ = {};
  forget();
  if (faces_.empty()) return;

  const auto particles = static_cast<std::size_t>(particle_count);
  owned_.assign(faces_.size(), 0);
  std::vector<char> has_owner(particles, 0);
  std::map<std::pair<int, int>, int> owner;
  std::vector<std::vector<int>> around(particles), next(particles);
  double length = 0;
  int edges = 0;  // of cloth
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = faces_[f].v[k], w = faces_[f].v[(k + 1) % 3];
      around[v].push_back(static_cast<int>(f));
      if (!has_owner[v]) owned_[f] |= static_cast<unsigned char>(1u << k);
      has_owner[v] = 1;
      if (!owner.emplace(std::minmax(v, w), static_cast<int>(f)).second) continue;
      owned_[f] |= static_cast<unsigned char>(8u << k);
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
  for (int c = 0; c < static_cast<int>(particles); ++c) {
    for (int f : around[c])
      for (int g : around[c])
        if (g > f && of_cloth_ == 0 && common(f, g) == c) list(f, g, beside_.list);
    beside_start_.push_back(static_cast<int>(beside_.list.size()));
  }
  beside_due_.assign(particles, never);
  beside_.due.assign(beside_.list.size(), never);
  beside_.normal.assign(beside_.list.size(), Vec3::Zero());
  clock_.assign(particles, 0);
  clock_end_.assign(particles, 0);
  spread(x, start_);
  boxes_.emplace(faces_, start_, 1, of_cloth_);
}

void Encounters::forget() {
  gap_ = -1;
  std::fill(beside_.due.begin(), beside_.due.end(), never);
  std::fill(beside_due_.begin(), beside_due_.end(), never);
}

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

bool Encounters::follow(const VecX& x, const VecX& x_new, double gap) {
  if (!x.allFinite() || !x_new.allFinite()) return false;
  read_clocks(x, x_new);
  return covers(x, x_new, gap) || search(x, x_new, gap);
}

// A list is good for motions whose ends are within its room of those that were searched, but for what all vertices
// move alike.
bool Encounters::covers(const VecX& x, const VecX& x_new, double gap) const {
  if (!(gap <= gap_)) return false;
  const auto within = [&](const VecX& at, const std::vector<Vec3>& searched) {
    const int n = static_cast<int>(searched.size());
    const auto moved = [&](int i) { return Vec3(at.segment<3>(3 * i) - searched[i]); };
    const Vec3 shift = mean(n, moved);
    return largest(n, [&](int i) { return (moved(i) - shift).lpNorm<Eigen::Infinity>(); }) <= room_;
  };
  return within(x, start_) && within(x_new, end_);
}

bool Encounters::search(const VecX& x, const VecX& x_new, double gap) {
  spread(x, start_);
  spread(x_new, end_);
  gap_ = gap;
  boxes_->refit(faces_, start_, end_);
  // A list that became long is made again with less room: it is looked through in every step. One that is long even so
  // is of cloth that has exploded.
  const std::size_t most = most_pairs * start_.size();
  if (room_ <= 0 || near_.list.size() < most / 4) room_ = std::min(2 * room_, most_room * mean_edge_);
  if (room_ <= 0) room_ = most_room * mean_edge_;
  const auto narrow = [&] { return room_ <= least_room * mean_edge_; };
  const auto list_is_made = [&] { return list_near(gap + 2 * room_, narrow() ? exploded * most : most); };
  bool listed = list_is_made();
  while (!listed && !narrow()) {
    room_ *= 0.5;
    listed = list_is_made();
  }
  if (!listed) {
    gap_ = -1;
    near_.list.clear();
  }
  near_.due.assign(near_.list.size(), never);
  near_.normal.assign(near_.list.size(), Vec3::Zero());
  return listed;
}

// Lists the pairs that come within this distance. False: they are more than `most`.
bool Encounters::list_near(double within, std::size_t most) {
  near_.list.clear();
  const int parts = static_cast<int>(boxes_->parts().size());
  listed_.resize(boxes_->parts().size());
  std::atomic<std::size_t> count = 0;
  parallel_for(parts, static_cast<int>(start_.size()) < serial_below, [&](int part) {
    std::vector<Encounter>& found = listed_[part];
    found.clear();
    boxes_->pairs_of(
        boxes_->parts()[part],
        [&](int first, int second) {
          if (common(first, second) >= 0) return true;
          if (of_cloth_ != 0 && (first < of_cloth_) == (second < of_cloth_)) return true;
          const auto before = static_cast<std::ptrdiff_t>(found.size());
          list(std::min(first, second), std::max(first, second), found);
          const auto far = [&](const Encounter& e) {
            const std::size_t cut = e.edges ? 2 : 1;
            return !touch(box_about(e, 0, cut), box_about(e, cut, 4), within);
          };
          found.erase(std::remove_if(found.begin() + before, found.end(), far), found.end());
          const auto added = found.size() - static_cast<std::size_t>(before);
          return added == 0 || count.fetch_add(added, std::memory_order_relaxed) + added <= most;
        },
        within);
  });
  if (count > most) return false;
  for (const std::vector<Encounter>& found : listed_)
    near_.list.insert(near_.list.end(), found.begin(), found.end());
  return true;
}

void Encounters::read_clocks(const VecX& x, const VecX& x_new) {
  const int n = static_cast<int>(clock_.size());
  const auto motion = [&](int i) { return Vec3(x_new.segment<3>(3 * i) - x.segment<3>(3 * i)); };
  const Vec3 common = mean(n, motion);
  common_clock_end_ = common_clock_ + largest(n, [&](int i) { return (motion(i) - common).norm(); });
  if (beside_.list.empty()) return;
  for_chunks(n, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Vec3 own = motion(i);
      double most = 0;
      for (int k = next_start_[i]; k < next_start_[i + 1]; ++k)
        most = std::max(most, (motion(next_[k]) - own).squaredNorm());
      clock_end_[i] = clock_[i] + std::sqrt(most);
    }
  });
}

void Encounters::went(const VecX& x, const VecX& x_new) {
  read_clocks(x, x_new);
  clock_ = clock_end_;
  common_clock_ = common_clock_end_;
}

}  // namespace drape::internal
