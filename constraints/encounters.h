// Which vertices and triangles, and which edges, of the cloth could meet in a step.
//   A segment of a rope goes along with the triangles as {i, j, j}: it owns vertices and its one edge as they
//   do, and is met as they are, by the vertices that come near it and by its edge.
//   Two triangles are looked at when their boxes come near each other at a common time, and the normal of one
//   does not keep them apart. Each vertex and each edge is owned by one of its triangles, so that a pair of
//   them comes up once. Triangles with a common vertex are always near: their pairs are listed once and for
//   all. The others are listed for every two patches of up to 32 triangles that come near each other. Such a
//   list stands as long as the motions of its two patches have not come to differ by more from what they were
//   when it was made, in either patch or from patch to patch, than it allows for: what moves wildly
//   elsewhere, and what both do alike, leaves it as it is. In a dense pile all lists allow for less, because
//   every pair of them costs something in every step.
//   Patches side by side, and the triangles of a vertex, that surely do not meet, since the cloth is hardly
//   folded there, need no list (unfolded.h). They sleep: what is known of their pairs is not kept up, and is
//   found anew when they wake.
//   What was found to be apart is not looked at again before it can have come near. No two points of two
//   patches come nearer to each other in a step than the motions of their vertices differ at most, and no two
//   of triangles that share the vertex c than by 2 e_c, where e_c is by how much the vertices next to c move
//   otherwise than c.
// The lists are the same on any number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "constraints/unfolded.h"
#include "mesh/base/parallel.h"
#include "mesh/distance/approach.h"
#include "mesh/distance/moving_boxes.h"

namespace drape::internal {

// A pair that comes near, and how.
struct Meeting {
  Encounter who;
  Approach approach;
};

inline FourPoints corners(const VecX& x, const Encounter& e) {
  FourPoints all;
  for (std::size_t k = 0; k < 4; ++k) all[k] = x.segment<3>(3 * e.v[k]);
  return all;
}

// No two things end a step nearer than this, or come nearer than half of it on the way [m]: places that are
// written as floats then do not cross, either.
inline double floor_of(const VecX& x, const VecX& x_new) {
  const double largest = std::max(x.lpNorm<Eigen::Infinity>(), x_new.lpNorm<Eigen::Infinity>());
  return 4 * std::sqrt(3.0) * std::ldexp(largest, -24);
}

class Encounters {
 public:
  // Triangles between the first so many particles, each once; a triangle that names a particle twice does not
  // count. of_cloth: so many of the triangles are of cloth, and only their pairs with the others are looked
  // for, without those of a vertex of cloth; all are of cloth: the pairs between all are, and those of the
  // segments with all. still: of each particle, whether it is at the same place in all steps; none is where
  // nothing is given.
  void set(const std::vector<Triangle>& triangles, const std::vector<std::array<int, 2>>& segments,
           int particles, std::size_t of_cloth, const VecX& x, const std::vector<char>& still = {});

  // Prepares for select() with this motion x -> x_new and gaps up to this one [m]. Searches only where what
  // is known does not cover the motion. False: a place is no number, or so much comes near so much else that
  // the cloth must have exploded; then there is no list.
  bool follow(const VecX& x, const VecX& x_new, double gap);
  enum class Kind { vertices = 1, edges = 2, both = 3 };
  // Asks look(pair, corners at x, corners at x_new, the normal found last), which returns an Approach, of the
  // pairs of these kinds that could come within gap_of(pair), at most `gap`, by all threads. Returns those
  // that are not apart, in a fixed order. They stay until the next call. limits: gap_of(pair) is at most the
  // least of these of its particles [m]; one caller may give some for edges, so that lists are not gone
  // through of which no pair can be near enough.
  template <class GapOf, class Look>
  std::vector<Meeting>& select(Kind kind, const VecX& x, const VecX& x_new, double gap, const GapOf& gap_of,
                               const Look& look, const std::vector<double>* limits = nullptr);
  // The step has gone from x to x_new.
  void went(const VecX& x, const VecX& x_new);
  void forget();  // the particles were moved from outside

 private:
  struct Box {
    std::array<Eigen::Array3d, 2> lower, upper;  // at both ends of the motion
  };
  // Pairs with the reading of their clock up to which they are surely farther apart than due - clock.
  struct Pairs {
    std::vector<Encounter> list;
    std::vector<double> due;   // m
    std::vector<Vec3> normal;  // that of the last look
  };
  // By how much two things can have come nearer to each other, summed up over the steps, at the start and at
  // the end of the motion [m].
  struct Clock {
    double start = 0, end = 0;
  };
  static constexpr double at_once = -std::numeric_limits<double>::infinity();  // a due, whatever the clock
  // A list has two parts, vertices with triangles and then edges. When the first pair of each is due.
  using Due = std::array<double, 2>;
  // The range of a vector over the vertices of a patch [m].
  struct Range {
    Eigen::Array3d lower = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  };
  using Ranges = std::vector<Range>;  // by patch
  // The pairs of two patches, or within one, that come within the gap, for motions that differ from the one
  // they were searched for by at most `room`.
  struct Group {
    int first = 0, second = 0;  // patches
    Clock clock;
    Due due = {};
    double wanted = 0;  // when the first pair of edges can be nearer than the limits of its particles
    double start_off = 0, end_off = 0;  // by how much the two ends of the motion differ by now at most [m]
    double gap = -1, room = 0;          // m
    int region = -1;                    // of unfolded_
    Pairs pairs;
    int edges_from = 0;  // where the second part of the list begins
  };
  static bool is_of_vertex(const Encounter& e) { return !e.edges; }
  void list(int first, int second, std::vector<Encounter>& found) const;
  void spread(const VecX& x, std::vector<Vec3>& places) const;  // those that move
  Box box_about(const Encounter& e, std::size_t from, std::size_t to) const;
  bool touch(const Box& a, const Box& b, double reach) const;
  bool apart_along_normal(int first, int second, double reach) const;
  int common(int first, int second) const;  // the lowest common vertex; -1: none
  static Eigen::Array3d difference(const Range& a, const Range& b);
  static double largest_difference(const Ranges& ranges);
  template <class Change>
  void measure(const Change& change, Ranges& ranges) const;
  bool group_patches(double gap);
  bool make_lists(double gap, bool fitted);
  void fit_stale_patches();
  void wake_vertices();
  void make_list(Group& group, double gap) const;
  void adapt_room(std::size_t pairs);
  bool search(Group& group, double within, std::size_t most) const;
  void read_clocks(const VecX& x, const VecX& x_new);
  void take(const std::vector<double>& limits, double gap);
  double limit_of(const Encounter& e) const {
    return std::min({limits_[e.v[0]], limits_[e.v[1]], limits_[e.v[2]], limits_[e.v[3]]});
  }
  template <class GapOf, class Look>
  void select_pair(Pairs& pairs, std::size_t k, Clock clock, const VecX& x, const VecX& x_new,
                   const GapOf& gap_of, const Look& look, std::vector<Meeting>& found) const;
  template <class Select>
  void select_chunks(int n, int in_a_chunk, const Select& select);

  std::vector<Face> faces_;
  int particles_ = 0, of_cloth_ = 0;  // of_cloth_: faces, 0 where pairs between all are looked for
  std::vector<unsigned char>
      owned_;  // of each face: bits 0 to 2 its vertices, bits 3 to 5 its edges k to k + 1
  std::optional<MovingBoxes> boxes_;
  std::optional<Unfolded> unfolded_;      // of cloth with cloth
  std::vector<int> next_start_, next_;    // the vertices next to each one
  std::vector<int> patch_start_, patch_;  // the vertices of each patch
  std::vector<int> moving_;               // particles that are not still
  std::vector<char> patch_moves_;         // whether any of its vertices does
  // The pairs that have the common vertex c are the numbers beside_start_[c] to beside_start_[c + 1] of
  // beside_; those of edges begin at beside_edges_[c], and none is due before beside_due_[c].
  Pairs beside_;
  std::vector<int> beside_start_, beside_edges_;
  std::vector<Due> beside_due_;
  std::vector<Clock> clock_;      // by vertex
  bool clocks_are_read_ = false;  // for the motion from start_ to end_
  std::vector<char> asleep_;      // by vertex
  // Numbers of what does not sleep in the motion that was followed last.
  std::vector<int> awake_groups_, awake_vertices_;
  std::vector<double> limits_;          // given last, by particle, at most the gap [m]
  std::vector<Group> groups_;           // sorted by patches
  std::vector<Vec3> start_, end_;       // of the motion that was followed last
  double gap_ = -1, mean_edge_ = 0;     // m
  double room_ = 0, grouped_room_ = 0;  // of new lists, and that for which patches were grouped [m]
  double start_off_ = 0,
         end_off_ = 0;  // by how much any two vertices moved differently since patches were grouped [m]
  Ranges of_start_, of_end_, of_motion_;      // scratch
  std::vector<double> rises_;                 // scratch of take(), by patch [m]
  std::vector<Group> old_, spare_;            // scratch of group_patches()
  std::vector<std::pair<int, int>> near_;     // scratch
  std::vector<int> stale_;                    // scratch: numbers of groups
  std::vector<char> patch_is_stale_;          // scratch
  std::vector<std::vector<Meeting>> chunks_;  // scratch of select()
  std::vector<Meeting> selected_;
};

template <class GapOf, class Look>
std::vector<Meeting>& Encounters::select(Kind kind, const VecX& x, const VecX& x_new, double gap,
                                         const GapOf& gap_of, const Look& look,
                                         const std::vector<double>* limits) {
  constexpr int groups_in_a_chunk = 8;
  constexpr double never = std::numeric_limits<double>::infinity();
  selected_.clear();
  if (faces_.empty()) return selected_;
  if (limits) take(*limits, gap);
  // The pairs of a part of a list, from `begin` to `end`. wanted: of the list, or null.
  const auto select_part = [&](Pairs& pairs, int begin, int end, const Clock& clock, double& due,
                               double* wanted, std::vector<Meeting>& found) {
    if (due - clock.end > gap || (wanted && *wanted > clock.end)) return;
    due = never;
    if (wanted) *wanted = never;
    for (int k = begin; k < end;) {
      // Most pairs are not due, and are looked at by fours.
      const int next = std::min(k + 4, end);
      double first = pairs.due[k];
      for (int other = k + 1; other < next; ++other) first = std::min(first, pairs.due[other]);
      if (first - clock.end > gap) {
        due = std::min(due, first);
        if (wanted) *wanted = std::min(*wanted, first - gap);
        k = next;
      }
      for (; k < next; ++k) {
        if (pairs.due[k] - clock.end <= gap) select_pair(pairs, k, clock, x, x_new, gap_of, look, found);
        due = std::min(due, pairs.due[k]);
        if (wanted) *wanted = std::min(*wanted, pairs.due[k] - limit_of(pairs.list[k]));
      }
    }
  };
  const auto select_list = [&](Pairs& pairs, const std::array<int, 3>& from, const Clock& clock, Due& due,
                               double* wanted, std::vector<Meeting>& found) {
    if (kind != Kind::edges) select_part(pairs, from[0], from[1], clock, due[0], nullptr, found);
    if (kind != Kind::vertices) select_part(pairs, from[1], from[2], clock, due[1], wanted, found);
  };
  const int groups = static_cast<int>(awake_groups_.size());
  select_chunks(groups, groups_in_a_chunk, [&](int k, std::vector<Meeting>& found) {
    Group& g = groups_[awake_groups_[k]];
    select_list(g.pairs, {0, g.edges_from, static_cast<int>(g.pairs.list.size())}, g.clock, g.due,
                limits ? &g.wanted : nullptr, found);
  });
  const int vertices = static_cast<int>(awake_vertices_.size());
  select_chunks(vertices, heavy_chunk_size(vertices), [&](int k, std::vector<Meeting>& found) {
    const int c = awake_vertices_[k];
    select_list(beside_, {beside_start_[c], beside_edges_[c], beside_start_[c + 1]}, clock_[c],
                beside_due_[c], nullptr, found);
  });
  return selected_;
}

// Calls select(k, the list to add to) for k < n, by all threads.
template <class Select>
void Encounters::select_chunks(int n, int in_a_chunk, const Select& select) {
  const int count = (n + in_a_chunk - 1) / in_a_chunk;
  if (chunks_.size() < static_cast<std::size_t>(count)) chunks_.resize(count);
  parallel_for(count, particles_ < serial_below(Work::heavy), [&](int chunk) {
    std::vector<Meeting>& found = chunks_[chunk];
    found.clear();
    for (int k = chunk * in_a_chunk; k < std::min(n, (chunk + 1) * in_a_chunk); ++k) select(k, found);
  });
  for (int k = 0; k < count; ++k) selected_.insert(selected_.end(), chunks_[k].begin(), chunks_[k].end());
}

// Of a pair that is due.
template <class GapOf, class Look>
void Encounters::select_pair(Pairs& pairs, std::size_t k, Clock clock, const VecX& x, const VecX& x_new,
                             const GapOf& gap_of, const Look& look, std::vector<Meeting>& found) const {
  const double least = pairs.due[k] - clock.end;  // so far apart it stays at least [m]
  const Encounter& e = pairs.list[k];
  if (least > gap_of(e)) return;
  Meeting one{.who = e, .approach = look(e, corners(x, e), corners(x_new, e), pairs.normal[k])};
  pairs.due[k] = clock.start + one.approach.start;
  pairs.normal[k] = one.approach.last.normal;
  if (!one.approach.apart) found.push_back(one);
}

}  // namespace drape::internal
