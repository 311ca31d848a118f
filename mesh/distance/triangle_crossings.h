// Where the triangles of a mesh pass through each other, as exact as the coordinates are given.
//   Two triangles without a common vertex cross when an edge of one passes through the other: its ends lie
//   strictly on both sides of the plane, and it meets the triangle, border included. Triangles that only
//   touch do not cross. A triangle that names a vertex twice, or has one that is not at a finite place, does
//   not count.
// A segment of a rope, which has no area, is given as {i, j, j}. It crosses a triangle when it passes through
// it. The signs are those of mesh/base/predicates.h, so that rounding neither hides a crossing nor makes one.
// Crossings that are joined make a contour: the line along which two sheets pass through each other. It is
// closed, or it ends at a border or at a fold.                              [Volino & Magnenat-Thalmann 2006]
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct TrianglePair {
  int first, second;  // triangles, first < second
  bool operator==(const TrianglePair&) const = default;
  bool operator<(const TrianglePair& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

// An edge passes through a triangle.
struct Passage {
  int a, b;  // the edge's ends, a < b
  int of;  // a triangle that has this edge; it crosses the other one, and their common line begins at the edge
  int through;  // the other triangle
};

struct CrossingContour {
  std::vector<TrianglePair> pairs;  // sorted
  std::vector<Passage>
      passages;  // in fixed order; an edge between two triangles that both cross is told for each
  bool closed = false;
  Vec3 place = Vec3::Zero();  // the point of the contour that its first pair has [m]
};

// The contours, the one of most pairs first; of equal ones that of the lowest triangle. A pair of triangles
// is in one of them. The search ends when most_crossing_pairs are found, as in cloth that has exploded.
constexpr int most_crossing_pairs = 1'000'000;
// segments: so many of the last triangles are segments.
std::vector<CrossingContour> crossing_contours(const std::vector<Vec3>& positions,
                                               const std::vector<Triangle>& triangles, int segments = 0);
// The same, of pairs of one of the first `count` triangles with one of the others, such as of cloth with a
// body.
std::vector<CrossingContour> contours_between(const std::vector<Vec3>& positions,
                                              const std::vector<Triangle>& triangles, int count);

// How many pairs of triangles cross in all of the contours.
int crossing_count(const std::vector<CrossingContour>& contours);

}  // namespace drape
