// Delaunay refinement of the panels of a pattern, all at once because seams couple them.
//   A triangle is bad when its smallest angle is below the bound or its longest edge is above the longest
//   allowed. Bad triangles get a vertex at the centre of their circle, the largest circle first. A piece of
//   the boundary whose circle holds a vertex, or would hold the new one, is split instead: in the middle, on
//   the curve itself, together with all pieces that are sewn on it  [Ruppert 1995; Shewchuk 2002].
//   At sharp corners of the drawing the first pieces of both sides are equally long and are halved together.
//   A triangle whose shortest edge spans such a corner, with both ends equally far from it, is left as it is
//   [Miller, Pav & Walkington 2003].
// No piece is split below 1/1000 of the edge, and the number of vertices is limited, so that refinement ends
// for every drawing; the triangles that stay bad are counted.
#pragma once

#include <memory>
#include <vector>

#include "mesh/pattern/delaunay.h"
#include "mesh/pattern/sides.h"

namespace drape::internal {

struct Refined {
  std::vector<Delaunay> panels;    // vertex v of panel p of Sides is v + Delaunay::kBoxCorners here
  std::vector<Subsegment> pieces;  // of all panels; the pieces of Sides keep their numbers
};

// `sides` receives the leg on which each new vertex lies. Throws InputError when the boundary of a panel does
// not bound an area.
Refined refine(const Pattern& pattern, Sides& sides, double edge, double min_angle, long most_vertices);

// Whether a triangle's shortest edge spans a sharp corner.
bool at_sharp_corner(const Sides& sides, const Delaunay& mesh, int panel, const Delaunay::Face& face);

}  // namespace drape::internal
