// Where cloth is surely not folded onto itself.
//   F(X) says how the cloth about a point X has turned and stretched since a reference. Take a region of it
//   over a convex part of a plane of normal N at the reference, and two points X and Y of it whose shadows on
//   that plane are P apart, in the direction d. The way from X to Y over the cloth that has a straight shadow
//   goes along t = d + s N, |s| <= slope. For any rotation R
//     d . R^T (x(Y) - x(X)) = int d . R^T F t dP,   so that   |x(Y) - x(X)| >= (1 - e) P
//   with e = max over the region, d and s of 1 - d . R^T F t. Where e < 1 the region cannot meet itself.
//     F is linear in the places of the corners, and so is d . R^T F t: e at both ends of a straight motion is
//   e for all of it. P is at least the least height of the shadows of the triangles, for a vertex and a
//   triangle, or two edges, without a vertex in common: planar triangles are no nearer to what they do not
//   touch. (That maps of convex regions are one to one where their gradient stays near to one matrix: John
//   1968, "On quasi-isometric mappings I".)
//     Triangles are looked at by patches. With a rotation G of each patch of normal n, and F - G in parts along
//   and across n, of norms `across` and `along`, P the plane's projection,
//     d . R^T F t >= d . R^T G t - |t| (along + |P R^T G n| across).
// Motions that follow on each other share an end, of which what is known is kept.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "mesh/distance/moving_boxes.h"

namespace drape::internal {

class Unfolded {
 public:
  // The reference: the faces at these places, in the patches of the boxes.
  Unfolded(const std::vector<Face>& faces, const MovingBoxes& boxes, const std::vector<Vec3>& places);
  // Looks at a motion, in which vertices go straight from `start` to `end`: which regions have no two parts
  // within this gap [m]. What is folded is not looked at again for a while.
  void look(const std::vector<Vec3>& start, const std::vector<Vec3>& end, double gap);
  // The region about two patches, first <= second, or about the triangles of a vertex; -1: it is curved at
  // the reference, or the cloth ends there.
  int region_of(int first, int second) const;
  int region_of_vertex(int vertex) const { return of_vertex_[vertex]; }
  // Whether all pairs of the region that have no vertex in common stay farther apart than the gap.
  bool is_apart(int region) const { return region >= 0 && apart_[region] != 0; }

 private:
  using Plane = std::array<Vec3, 2>;
  // A triangle at the reference: its first edge is length t_0, its second one `along` length t_0 + height
  // t_1.
  struct Shape {
    Triangle v;
    Plane t;
    double inverse_length, along, inverse_height;
  };
  struct Turn {
    Mat3 G;
    Eigen::Vector4d q;     // G as a unit quaternion
    double along, across;  // by how much F differs from G at most, along the patch and across it
  };
  // Patches that are looked at together, and the plane of their regions.
  struct Patches {
    std::vector<int> all;
    Vec3 normal;
    Plane plane;
    double slope = 0, height = 0;  // the largest of any region; m
    int rests = 0;                 // looks for which it is left alone
    double off = 0;                // e
  };
  struct Region {
    int patches;    // a number of Patches
    double height;  // m
  };
  class Builder;
  void add_shape(const Triangle& v, const std::vector<Vec3>& places);
  Turn turn_of(int patch, const std::vector<Vec3>& x) const;
  double off_of(const Patches& patches) const;
  double off_by_angles(const Patches& patches) const;

  std::vector<Shape> shapes_;  // patch by patch
  std::vector<int> shapes_from_;
  std::vector<Vec3> normals_;  // of each patch
  std::vector<Plane> planes_;
  std::vector<Patches> patches_;
  std::vector<Region> regions_;
  std::map<std::pair<int, int>, int> pairs_;  // regions
  std::vector<int> of_vertex_;
  std::vector<char> apart_;  // by region
  struct Ends {
    std::array<Turn, 2> turn;
    bool wanted = false;
    long looked = -1;  // the look in which they were found
  };
  std::vector<Ends> ends_;  // by patch
  long looks_ = 0;
  std::vector<Vec3> start_, end_;  // of the motion that was looked at last
};

}  // namespace drape::internal
