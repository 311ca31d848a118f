// Cloth that starts through itself: where it may pass, and what brings it apart.
//   A tangle is all vertices of the triangles that cross along a contour [mesh/distance/triangle_crossings.h], and of
//   those around them; contours that share such a vertex make one tangle. Within a tangle nothing is kept apart, between
//   all else everything is.
//   The edges that cross something divide the cloth into regions. An edge between two regions moves against the triangle
//   that it passes through, along the normal of that triangle, so that its end in the lighter region comes back:
//     +-N, of the side of the contour that has the lightest region
//   Where layers are given, the order says which end is to come back: the higher layer passes to the side where the normal N
//   of the lower one points, whichever of the two the edge is of.
//   Where a contour divides no region off, as between two borders, it is made shorter. An edge E then moves along
//     G = sum_i (R_i - (R_i . E) / (E . N) N)                     [Volino & Magnenat-Thalmann 2006, section 3]
//   R_i: the direction in which the contour goes on from the edge, one for each triangle at the edge that crosses; both
//   sides move as wholes along the sum of G, besides.
//   These are displacements without velocity, which spread to two rings of triangles around, or to one when
//   that has not helped for 1 s: narrow folds would move as wholes. Masses share them, so that no
//   momentum is made. They are bounded by a speed, and by how much they stretch an edge in a step.
//   A rope that passes through cloth is divided by it, and comes back as cloth does; it has no contour to make shorter.
//   The number of pairs that cross goes up and down while a contour moves over triangles. It may exceed its least so far
//   by a quarter and a few; where a step makes more, the tangles that grow move as wholes. When it has not become less for
//   2 s, the tangles are left as they are.
// Internal to the library's constraints.
#pragma once

#include <optional>
#include <vector>

#include "constraints/step_motion.h"
#include "mesh/distance/triangle_crossings.h"

namespace drape::internal {

class Tangles {
 public:
  // Looks where the triangles cross. pass: for each particle whether what is near it may cross; two triangles that both
  // have such a one make no tangle. layers: of the triangles, see SelfFace. segments: so many of the last triangles are
  // segments of ropes, see crossing_contours().
  void begin(std::vector<Triangle> triangles, int segments, std::vector<std::optional<int>> layers,
             const std::vector<char>& pass, const VecX& x);
  void end_step(const VecX& x);  // the step has ended at x

  bool any() const { return !contours_.empty(); }
  int tangle(int particle) const { return tangle_[particle]; }  // a number; -1: it is in none
  int particles() const { return particles_; }                  // in all tangles
  // Displacements that bring the sides of the contours apart, by `most` [m] at most; zero farther than
  // a ring of triangles outside of the tangles.
  const VecX& relief(const StepMotion& step, double most);
  // The tangles that have to stand, when more pairs would cross at x than may; sorted.
  const std::vector<int>& growing(const VecX& x);

 private:
  void look(const VecX& x);
  void leave_out_passing();
  void mark();
  void find_regions(const StepMotion& step);
  int lighter_end(const Passage& passage) const;
  void sort_sides(const CrossingContour& contour);
  int lightest_side(const CrossingContour& contour) const;
  std::optional<Vec3> way_by_layers(const Passage& passage) const;
  void gather(const CrossingContour& contour, int rings);
  void add_ways(const CrossingContour& contour, const StepMotion& step);
  void spread(const StepMotion& step);
  double excess_of(const Triangle& t, const VecX& ways, double most) const;
  void add_relief(double most);
  void limit_relief(double most);

  std::vector<Triangle> triangles_;
  int segments_ = 0;
  std::vector<std::optional<int>> layers_;
  std::vector<char> passes_;  // by triangle
  std::vector<int> first_,
      around_;                // the triangles at particle i: around_[first_[i]] up to around_[first_[i + 1]]
  std::vector<Vec3> places_;  // seen_
  std::vector<CrossingContour> contours_, found_;  // where the step began, and at seen_
  VecX seen_;
  int fewest_ = 0;      // pairs that crossed at the end of a step so far
  double stalled_ = 0;  // s, since it became less
  int particles_ = 0;
  std::vector<int> tangle_, moved_;  // the number of the tangle that a particle is in, and that moves it
  // Regions: that of each particle, and the mass of each [kg], infinite where a particle is held.
  std::vector<int> region_;
  std::vector<double> region_mass_;
  // Of the contour that is looked at: the triangles at it and around it, their side, 1 or -1, 0: unknown, and displacements.
  std::vector<int> near_;
  std::vector<char> is_near_;
  std::vector<int> side_;
  VecX way_, relief_;           // m
  std::vector<double> excess_;  // by tangle
  std::vector<int> gain_, growing_;
};

}  // namespace drape::internal
