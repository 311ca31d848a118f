// A still made ready for rays: all triangles in one tree, with normals and colours, and the planes.
#pragma once

#include <optional>

#include "app/picture/normals.h"
#include "app/picture/render.h"
#include "mesh/distance/triangle_tree.h"

namespace drape::app::drawing {

// What a ray from the eye hits.
struct Seen {
  int part = -1;  // part of the still; -1: nothing; -2 - k: plane k
  double distance = 0;
  Vec3 point, from;              // m; `from` is where further rays start, clear of its own triangle
  Eigen::Vector3f normal;        // unit vector, towards the viewer
  Light colour = Light::Zero();  // in full light
  float fade = 1;                // of a plane: 1 near the scene, 0 where it ends
};

class Surface {
 public:
  Surface(const Still& still, const Look& look);

  // Finds what the ray hits first. `slope` is Camera::slope.
  Seen seen(const Vec3& eye, const Vec3& direction, double slope) const;
  bool blocked(const Vec3& from, const Vec3& direction, double distance) const {
    return tree_ && tree_->blocked(from, direction, distance);
  }
  // The same, but planes count too.
  bool covered(const Vec3& from, const Vec3& direction, double distance) const;

 private:
  struct Piece {  // the place of a part's triangles among all triangles
    int begin;
    const StillPart* part;
    Light front, back, mark;
  };
  void meet(Seen& seen, const Vec3& direction, const TriangleTree::Hit& hit, double slope) const;
  void meet_planes(Seen& seen, const Vec3& eye, const Vec3& direction) const;
  Light colour(const Piece& piece, int triangle, const Vec3& weights, bool front) const;

  const Still& still_;
  const Look& look_;
  std::vector<Piece> pieces_;
  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
  std::vector<CornerNormals> normals_;
  std::vector<int> piece_of_;  // for each triangle, the number of its piece
  std::optional<TriangleTree> tree_;
};

}  // namespace drape::app::drawing
