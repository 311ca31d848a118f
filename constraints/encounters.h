// Which vertices and triangles, and which edges, of the cloth could meet in a step.
//   Two triangles are looked at when their boxes come near each other at a common time. Each vertex and each edge is
//   owned by one of its triangles, so that a pair of them comes up once. Triangles with a common vertex are always
//   near: their pairs are listed once and for all.
//   What was found to be apart is not looked at again before it can have come near. Of triangles that share the
//   vertex c, no two points come nearer to each other by more than 2 e_c, where e_c sums up over the steps by how much
//   the vertices next to c move otherwise than c. Of the other pairs it is 2 e, where e sums up by how much any vertex
//   moves otherwise than the mean of all.
// The lists are the same on any number of threads.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

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

class Encounters {
 public:
  // Triangles between the first so many particles, each once; a triangle that names a particle twice does not count.
  // of_cloth: so many of the triangles are of cloth, and only their pairs with the others are looked for, without those
  // of a vertex of cloth; all are of cloth: the pairs between all are.
  void set(const std::vector<Triangle>& triangles, int particles, std::size_t of_cloth, const VecX& x);
  double mean_edge() const { return mean_edge_; }  // when the triangles were set [m]

  // Prepares for select() with motions x -> x_new and gaps up to this one [m]. Searches only where what is known does
  // not cover this motion. False: a place is no number, or so much comes near so much else that the cloth must have
  // exploded; then there is no list.
  bool follow(const VecX& x, const VecX& x_new, double gap);
  // Asks look(pair, corners at x, corners at x_new, the normal found last), which returns an Approach, of the pairs
  // that could come within the gap, by all threads. Returns those that are not apart, in a fixed order. They stay
  // until the next call.
  template <class Look>
  std::vector<Meeting>& select(const VecX& x, const VecX& x_new, double gap, const Look& look);
  // The step has gone from x to x_new.
  void went(const VecX& x, const VecX& x_new);
  void forget();  // the particles were moved from outside

 private:
  struct Box {
    std::array<Eigen::Array3d, 2> lower, upper;  // at both ends of the motion
  };
  // Pairs with the reading of their clock up to which they are surely farther apart than 2 (due - clock).
  struct Pairs {
    std::vector<Encounter> list;
    std::vector<double> due;   // m
    std::vector<Vec3> normal;  // that of the last look
  };
  // The reading of a clock at the start and at the end of the motion [m].
  struct Clock {
    double start, end;
  };
  void list(int first, int second, std::vector<Encounter>& found) const;
  void spread(const VecX& x, std::vector<Vec3>& places) const;
  Box box_about(const Encounter& e, std::size_t from, std::size_t to) const;
  bool touch(const Box& a, const Box& b, double reach) const;
  int common(int first, int second) const;  // the lowest common vertex; -1: none
  bool covers(const VecX& x, const VecX& x_new, double gap) const;
  bool list_near(double within, std::size_t most);
  bool search(const VecX& x, const VecX& x_new, double gap);
  void read_clocks(const VecX& x, const VecX& x_new);
  template <class Look>
  double select_pair(Pairs& pairs, std::size_t k, Clock clock, const VecX& x, const VecX& x_new, double gap,
                     const Look& look, std::vector<Meeting>& found) const;
  template <class Select>
  void select_chunks(int n, const Select& select);

  std::vector<Face> faces_;
  int particles_ = 0, of_cloth_ = 0;  // of_cloth_: faces, 0 where pairs between all are looked for
  std::vector<unsigned char>
      owned_;  // of each face: bits 0 to 2 its vertices, bits 3 to 5 its edges k to k + 1
  std::optional<MovingBoxes> boxes_;
  std::vector<int> next_start_, next_;  // the vertices next to each one
  // The pairs that have the common vertex c are the numbers beside_start_[c] to beside_start_[c + 1] of beside_, and
  // none is due before beside_due_[c].
  Pairs beside_, near_;
  std::vector<int> beside_start_;
  std::vector<double> beside_due_;
  std::vector<Vec3> start_, end_;  // of the motion that was searched last
  double gap_ = -1, room_ = 0, mean_edge_ = 0;
  // Readings of the clocks at the start and at the end of the motion [m]: by vertex, and of all.
  std::vector<double> clock_, clock_end_;
  double common_clock_ = 0, common_clock_end_ = 0;
  std::vector<std::vector<Encounter>> listed_;  // scratch of list_near()
  std::vector<std::vector<Meeting>> chunks_;    // scratch of select()
  std::vector<Meeting> selected_;
};

template <class Look>
std::vector<Meeting>& Encounters::select(const VecX& x, const VecX& x_new, double gap, const Look& look) {
  selected_.clear();
  select_chunks(static_cast<int>(near_.list.size()), [&](int k, std::vector<Meeting>& found) {
    select_pair(near_, k, {common_clock_, common_clock_end_}, x, x_new, gap, look, found);
  });
  select_chunks(static_cast<int>(clock_.size()), [&](int c, std::vector<Meeting>& found) {
    if (2 * (beside_due_[c] - clock_end_[c]) > gap) return;
    double earliest = std::numeric_limits<double>::infinity();
    for (int k = beside_start_[c]; k < beside_start_[c + 1]; ++k)
      earliest =
          std::min(earliest, select_pair(beside_, k, {clock_[c], clock_end_[c]}, x, x_new, gap, look, found));
    beside_due_[c] = earliest;
  });
  return selected_;
}

// Calls select(k, the list to add to) for k < n, by all threads.
template <class Select>
void Encounters::select_chunks(int n, const Select& select) {
  const auto count = static_cast<std::size_t>(chunk_count(n));
  if (chunks_.size() < count) chunks_.resize(count);
  for_chunks(n, [&](int begin, int end) {
    std::vector<Meeting>& found = chunks_[static_cast<std::size_t>(begin / chunk_size)];
    found.clear();
    for (int k = begin; k < end; ++k) select(k, found);
  });
  for (std::size_t k = 0; k < count; ++k)
    selected_.insert(selected_.end(), chunks_[k].begin(), chunks_[k].end());
}

// Returns when the pair is due.
template <class Look>
double Encounters::select_pair(Pairs& pairs, std::size_t k, Clock clock, const VecX& x, const VecX& x_new,
                               double gap, const Look& look, std::vector<Meeting>& found) const {
  if (2 * (pairs.due[k] - clock.end) > gap) return pairs.due[k];
  const Encounter& e = pairs.list[k];
  Meeting one{.who = e, .approach = look(e, corners(x, e), corners(x_new, e), pairs.normal[k])};
  pairs.due[k] = clock.start + 0.5 * one.approach.start;
  pairs.normal[k] = one.approach.last.normal;
  if (!one.approach.apart) found.push_back(one);
  return pairs.due[k];
}

}  // namespace drape::internal
