// Where cloth is surely not folded onto itself.
//   F(X) says how the cloth about a point X has turned and stretched since a reference. Take a region of it
// that lies over a convex part of a plane of normal N at the reference, and two points X and Y of it whose
// shadows on that plane are p apart, in the direction d. The way from X to Y over the cloth that has a
// straight shadow goes along t = d + s N, where |s| is at most the slope of the region. For any rotation R
//     d . R^T (x(Y) - x(X)) = int d . R^T F t dp,   so that   |x(Y) - x(X)| >= (1 - e) p
// with e the largest of 1 - d . R^T F t in the region. Where e < 1 the region cannot meet itself.
//   F is linear in the places of the corners, and so is d . R^T F t: what bounds e at both ends of a straight
// motion bounds it all the way. R is how the region had turned at the start, in the mean,
// when e was found.
//   For a vertex and a triangle, or two edges, without a vertex in common p is at least the least height of
// the triangles' shadows: the straight way from a vertex leaves the triangle that it begins in over the edge
// across from it, and two edges that do not cross are nearest at an end of one. (That maps of convex regions
// are one to one where their gradient stays near to one matrix is known [John 1968].)
//   Triangles are looked at by patches. Let G be a rotation near to F in a patch, and n the normal of the
// patch as G turns it. F - G has a part across n and one along it, of norms `in_plane` and `out_of_plane`,
// and Q takes a vector's part in the region's plane, as R turns it:
//     d . R^T F t >= d . R^T G t - |t| (in_plane + |Q n| out_of_plane)
//   Where F changes by dF, e grows by |t| |dF| at most. So e is found again only when the changes since,
// added up, could have made a fold.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mesh/distance/moving_boxes.h"

namespace drape::internal {

class Unfolded {
 public:
  // The reference: the joined faces at these places, in the patches of the boxes.
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
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  struct Turn {
    Mat3 G = Mat3::Identity();
    Eigen::Vector4d q = Eigen::Vector4d::UnitW();  // G as a unit quaternion
    double in_plane = 0, out_of_plane = 0;         // by how much F differed from G at most
    double drift = 0;                              // |dF| since then, at most
  };
  // What a patch is at both ends of the motion.
  struct Ends {
    std::array<Turn, 2> turn;
    double most_drift = infinity;  // with so much or more the turns are found anew in this look
  };
  // Patches that are looked at together, and the plane of the regions in them.
  struct PatchSet {
    int from = 0, to = 0;  // in set_patches_
    Vec3 normal;
    double slope = 0;          // the largest of any region, a tangent
    double height = infinity;  // the least of any region [m]
    int rests = 0;             // looks for which it is left alone
    double off = 0;            // e is no more than that; nothing at the reference
    bool wanted = false;       // in this look: `off` does not tell that all of it is apart
    bool folded = false;       // by the last look that wanted it
  };
  struct Region {
    int set;        // of patches
    double height;  // m
  };
  class Builder;
  void add_shape(const Triangle& v, const std::vector<Vec3>& places);
  double change_of(int patch, const std::vector<Vec3>& change) const;
  Turn turn_of(int patch, const std::vector<Vec3>& x) const;
  std::span<const int> patches_of(const PatchSet& set) const;
  static double longest_of(const PatchSet& set);
  double off_of(const PatchSet& set) const;
  double off_by_angles(const PatchSet& set) const;

  std::vector<Shape> shapes_;  // patch by patch
  std::vector<int> shapes_from_;
  std::vector<Vec3> normals_;  // of each patch
  std::vector<Plane> planes_;
  std::vector<PatchSet> sets_;
  std::vector<int> set_patches_;
  std::vector<Region> regions_;
  std::vector<std::pair<int, int>> pairs_;  // of patches that have a vertex in common, sorted
  std::vector<int> of_pair_, of_vertex_;    // regions
  std::vector<char> apart_;                 // by region
  std::vector<Ends> ends_;                  // by patch
  std::vector<double> change_;              // by patch: |dF| in this look at most, at either end
  // Where the motion that was looked at last started and ended, at first the reference; and, as scratch, by
  // how much the next one differs.
  std::array<std::vector<Vec3>, 2> places_, motion_;
};

}  // namespace drape::internal
