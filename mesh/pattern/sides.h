// The boundary of a pattern cut into pieces, which places the first vertices on outlines, holes and lines.
//   run     (ChainRun) the part of a chain with one name (a side that may be sewn), or one nameless segment
//   piece   (Subsegment, as Ruppert calls it) the part of a run between two successive vertices; it is an
//           edge of the mesh
//   twins   pieces that are sewn on one another: they lie at the same fractions of their runs and are split
//           together, so that the vertices of a seam always pair
//   corner  the place where two segments meet. At a sharp corner (less than 60 degrees inside the panel) the
//           first pieces of both sides are equally long and are halved together [Ruppert 1995, section 5.2,
//           "concentric shells"], so that the sides do not drive each other to ever shorter pieces.
#pragma once

#include <string>
#include <vector>

#include "mesh/pattern/pattern.h"

namespace drape::internal {

struct ChainRun {
  int panel;
  std::string name;  // PANEL.NAME, or empty
  bool boundary;     // part of an outline or a hole, with the panel on its left; else of an inner line
  bool closed;       // the run is a whole loop
  ArcLength curve;
  std::vector<int> corners;  // vertices at the ends of its segments, one more than segments
  int first_leg = 0;         // number of its first segment among all segments
  int seam_class = 0;        // the same for all runs that are sewn on one another
  bool turned = false;       // runs against the first run of its class
  std::string where;
};

struct Subsegment {
  int run;
  int a, b;            // vertices, in the direction of the run
  double f0, f1;       // fractions of the run's length
  int leg;             // the segment on which it lies
  int twin;            // the next of the pieces sewn together; itself when there is none
  bool stuck = false;  // cannot be split any further
};

// A segment, and the sharp corners (numbers from 0, or -1) at its start and end.
struct Leg {
  int run;
  int sharp[2] = {-1, -1};
};

struct Sides {
  std::vector<ChainRun> runs;
  std::vector<Leg> legs;
  std::vector<Subsegment> pieces;
  std::vector<std::vector<Vec2>> points;                    // of each panel; its corners come first
  std::vector<std::vector<std::vector<int>>> corner_legs;   // of each panel and corner
  static constexpr int kCorner = -1, kFree = -2;            // not on one leg: on several, on none
  std::vector<std::vector<int>> leg_of;                     // of each panel and point
  std::vector<SharpCorner> sharp;                           // corners sharper than the bound
  std::vector<std::vector<std::pair<int, bool>>> clusters;  // of each sharp corner: its legs, and which end
};

// Throws InputError; see triangulate().
Sides cut_sides(const Pattern& pattern, double edge, double tolerance, double min_angle);

std::string place_of(const Vec2& x);  // the place as messages give it

// The loop, turned round if necessary so that its area is on its left (`left`) or on its right.
Chain wound(const Chain& loop, bool left);

}  // namespace drape::internal
