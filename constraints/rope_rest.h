// Ropes among what meets in constraints/self_contact.h, and how far things lie from each other at rest along what joins
// them.
//   A segment of a rope is as thick as twice its radius, and mostly shorter than that: its neighbours along the rope are
// nearer than they could ever be pushed apart. So what hangs together is kept apart by no more than half of the way l [m]
// that leads from one to the other at rest:
//   along one rope   l = the length of rope between both
//   over a joint     l = d_A + d_B, the least over all joints; d: from the joint along edges and ropes
// A straight rope then presses on itself nowhere, nor one whose bends turn by less than 217 degrees on the length of two
// diameters: a chord of a circle is shorter than half of its arc only beyond that. Where the way is four radii or longer,
// the rope is as thick as anywhere.
// Internal to the library's constraints.
#pragma once

#include <limits>
#include <vector>

#include "constraints/self_contact.h"

namespace drape::internal {

class RopeRest {
 public:
  // rest: the places of the particles of the faces and segments at rest [m]; ropes rest with the lengths that they have
  // there. particles: of these and of bodies.
  void set(const std::vector<SelfSegment>& segments, const std::vector<SelfFace>& faces, const VecX& rest,
           int particles);

  bool any() const { return !chain_.empty(); }
  // Whether one of both sides is a rope.
  bool is_rope(const Encounter& e) const {
    return any() && (of_rope_[one_of(e, false)] != 0 || of_rope_[one_of(e, true)] != 0);
  }
  bool are_ropes(const Encounter& e) const {
    return any() && of_rope_[one_of(e, false)] != 0 && of_rope_[one_of(e, true)] != 0;
  }
  // A particle that stands for a side of a pair: a joint belongs to two things, so another one where there is one.
  int one_of(const Encounter& e, bool second) const;
  // The way from one side to the other [m]; infinite where it is longer than two thicknesses, or there is none.
  double way(const Encounter& e) const;

 private:
  struct Joint {
    int number;
    double way;  // m
  };
  void find_ways(const std::vector<SelfSegment>& segments, const std::vector<SelfFace>& faces,
                 const VecX& rest, double most);
  void find_ways_from(int number, int particle, const std::vector<std::vector<int>>& next, const VecX& rest,
                      double most);

  std::vector<int> chain_;                // the rope that the particle is of; -1: none
  std::vector<double> along_;             // its place on the rope [m]
  std::vector<char> of_rope_;             // of a rope and of no triangle
  std::vector<char> is_joint_;            // of a rope, and of a triangle or another rope
  std::vector<std::vector<Joint>> near_;  // joints near each particle, ascending
};

}  // namespace drape::internal
