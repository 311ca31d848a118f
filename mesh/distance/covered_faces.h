// Which parts of a closed surface lie inside the body, because the body overlaps itself: an arm in the torso,
// thighs that are pressed into each other, an eye in its head. They are no surface of the solid that all
// parts make together.
//   w(x) = 1 / (4 pi) sum over the triangles of their solid angles seen from x: how often the surface
//   surrounds x
//                        [Jacobson, Kavan & Sorkine-Hornung 2013, Robust inside-outside segmentation, eq. 5]
// A triangle is covered when w is at least 1 on the side to which its normal points. Far groups of triangles
// count as one, w is rounded to a whole number.
//                                             [Barill et al. 2018, Fast winding numbers for soups and clouds]
// Where triangles pass through each other they are covered in part, up to the contour along which they meet.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "mesh/distance/moving_boxes.h"

namespace drape::internal {

enum class Cover : char { none, part, all };

// The line along which two triangles meet: from a point of an edge to a point of another. A point is
// (1 - share) a + share b, a and b being vertices.
struct MeetingLine {
  struct End {
    int a, b;
    double share;
  };
  std::array<End, 2> ends;
  std::array<int, 2> faces;

  // The point at a share of the line, place(v) being where a vertex is.
  template <class Place>
  Vec3 at(double share, const Place& place) const {
    const auto end = [&](const End& e) {
      return Vec3((1 - e.share) * Vec3(place(e.a)) + e.share * Vec3(place(e.b)));
    };
    return (1 - share) * end(ends[0]) + share * end(ends[1]);
  }
};

class CoveredFaces {
 public:
  // Looks at a closed surface whose vertices are at x [m], and for whose way the boxes were fitted.
  void look(const std::vector<Face>& faces, const std::vector<Vec3>& x, const MovingBoxes& boxes);

  bool any() const { return any_; }
  Cover operator[](int face) const { return any_ ? cover_[face] : Cover::none; }
  // Whether a point of a face is covered. faces, x and boxes: as of the last look().
  bool covers(int face, const Vec3& weights, const std::vector<Face>& faces, const std::vector<Vec3>& x,
              const MovingBoxes& boxes) const;
  // The faces that a face which is covered in part passes through, ascending.
  std::span<const int> met_by(int face) const;
  // Where triangles meet, and no third part of the body covers them.
  const std::vector<MeetingLine>& lines() const { return lines_; }

 private:
  struct Group {
    Vec3 middle = Vec3::Zero(), area = Vec3::Zero();  // m, m^2: sum of the areas along the normals
    double radius = 0;                                // m
  };
  // Faces of a group that hang together and are bent little.
  struct Cluster {
    int first, count;              // of cluster_faces_, and of face_boxes_
    Eigen::AlignedBox3f box = {};  // m
    Vec3 axis = Vec3::Zero();      // about which the normals are
    double spread = 2;             // -cos(2 a), a: the largest angle of a normal to it; 2: over 90 degrees
  };
  void make_clusters(const std::vector<Face>& faces, const std::vector<Vec3>& x, const MovingBoxes& boxes);
  void make_neighbours(const std::vector<Face>& faces);
  void fit_cluster(Cluster& cluster, const std::vector<Face>& faces, const std::vector<Vec3>& x);
  bool cannot_meet(int cluster, int other) const;
  template <class Meet>
  void look_between(int group, int other, const Meet& meet) const;
  void find_meetings(const std::vector<Face>& faces, const std::vector<Vec3>& x, const MovingBoxes& boxes);
  void find_parts(const std::vector<Face>& faces);
  void spread_from_lines(const std::vector<Face>& faces, const std::vector<Vec3>& x,
                         const MovingBoxes& boxes);
  void group(const std::vector<Face>& faces, const std::vector<Vec3>& x, const MovingBoxes& boxes);
  double winding(const Vec3& from, const std::array<int, 2>& without, const std::vector<Face>& faces,
                 const std::vector<Vec3>& x, const MovingBoxes& boxes) const;

  // Made once, for the surface as it is when it is looked at first. What is found later depends on it where
  // the surface meets itself within a few triangles.
  std::vector<Cluster> clusters_;
  std::vector<int> cluster_faces_, group_start_;  // the clusters of a group stand side by side
  // Of a cluster: itself, and those that share a vertex with it.
  std::vector<int> neighbour_start_, neighbours_;
  bool in_pieces_ = false;  // the surface is not connected
  // Of the last look.
  std::vector<Eigen::AlignedBox3f> face_boxes_;  // rounded outwards [m]
  bool any_ = false;
  std::vector<Cover> cover_;
  std::vector<MeetingLine> lines_;
  std::vector<std::array<int, 2>> meetings_;  // each pair of faces both ways round, ascending
  std::vector<int> met_start_, met_by_;
  std::vector<int> part_start_,
      part_;  // faces that meet none, part by part of the surface; then those that are covered beside lines
  std::vector<char> seen_;
  std::vector<Group> groups_;
};

}  // namespace drape::internal
