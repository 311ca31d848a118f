// Signed distance from a point to a triangle surface, which is at rest or moves during a step.
//   closed     the distance is negative inside; its sign comes from the angle-weighted pseudo-normal of the
//              closest feature (vertex, edge or face)
//              [Baerentzen & Aanaes 2005, Signed distance computation using the angle weighted pseudonormal]
//   otherwise  the surface counts as a thick sheet: the distance is never negative, and the normal points
//              from the surface to the point
//
// A surface is closed when every edge has exactly two triangles and the surface has two sides. Each connected
// piece is wound outwards on its own. Where a closed surface overlaps itself (an arm in the torso), and where
// one piece lies in another (the inner wall of a hollow body), what is inside any of them is inside, and its
// distance is that to the surface of all of them together (mesh/distance/covered_faces.h).
//
// After move(start, end) every vertex goes straight from its start to its end while s [-] goes from 0 to 1,
// and every question is about the surface at a given s. Which triangles are neighbours and which side is
// outside does not change: the mesh at construction decides it.
//
// The search trees (Embree's for a surface at rest, our own for a moving one) only propose triangles. The
// distances are computed here in double precision, and a tie goes to the lowest triangle number, so the
// answer depends neither on the tree nor on the processor.
#pragma once

#include <memory>
#include <optional>

#include "mesh/triangles/mesh_frames.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct SurfacePoint {
  double distance;  // m, negative inside
  Vec3 normal;      // unit vector, the gradient of the distance: it points outwards
  // The nearest triangle of the surface lies inside, too: the point is where the body overlaps itself, or
  // beside that.
  bool covered = false;
};

// How far the vertices that belong to a triangle move during a step [m]. All values are 0 for a surface at
// rest.
struct SurfaceMotion {
  Vec3 mean = Vec3::Zero();  // mean displacement
  double about_mean = 0;     // largest difference between the displacement of a vertex and the mean
  double largest = 0;        // largest displacement of a vertex
};

class SurfaceDistance {
 public:
  // Throws InputError when no triangle has an area, or a vertex of one no finite position.
  explicit SurfaceDistance(const TriangleMesh& mesh);
  ~SurfaceDistance();
  SurfaceDistance(const SurfaceDistance&) = delete;
  SurfaceDistance& operator=(const SurfaceDistance&) = delete;

  // Begins a step, given the positions [m] of all vertices of the mesh at its start and at its end. Refits
  // the tree; allocates nothing after the first call. Throws InputError when the number of positions is not
  // that of the vertices.
  void move(const std::vector<Vec3>& start, const std::vector<Vec3>& end);
  // The same, for a step from the time t0 to the time t1 [s] of an animated body.
  void move(const MeshFrames& frames, double t0, double t1);
  const SurfaceMotion& motion() const;
  double largest_displacement() const { return motion().largest; }

  std::vector<Vec3> vertices(double s) const;  // positions of the mesh's vertices at s, m
  Vec3 vertex(int v, double s) const;          // of one

  // All the functions below may be called from several threads at once.
  SurfacePoint closest(const Vec3& x, double s = 0) const;
  // The same; `displacement` receives how far the surface point closest to x moves during the whole step [m].
  SurfacePoint closest(const Vec3& x, double s, Vec3& displacement) const;

  // The first s in [from, 1] at which the straight way from x0 (at s = 0) to x1 (at s = 1) goes through a
  // triangle. Where the surface is closed, only a way from outside to inside counts. The crossings are roots
  // of cubics (mesh/distance/crossing.h), so none is missed. A way that slides along the surface does not
  // cross it.
  std::optional<double> first_crossing(const Vec3& x0, const Vec3& x1, double from = 0) const;

  // True when no triangle comes as near as `margin` [m] to a point that goes straight from x0 (at s = 0) to
  // x1 (at s = 1). The test uses the distance at s = 0 and the relative displacement during the step, so it
  // may say false although the point does stay clear.
  bool stays_clear(const Vec3& x0, const Vec3& x1, double margin) const;

  // A point attached to the surface, described relative to its closest triangle.
  struct Anchor {
    Triangle triangle;  // its three vertices
    Vec3 weights;       // barycentric weights of the closest point of the triangle
    // From the closest point to the attached point [m]: along the first side of the triangle, across that
    // side within the triangle, and along the normal.
    Vec3 offset;
  };
  Anchor anchor(const Vec3& x, double s = 0) const;
  Vec3 place(const Anchor& anchor, double s) const;
  // Where the surface carries a point that is beside it at s, until s = 1. Where the body overlaps itself,
  // two parts of the surface carry it, and it goes the mean of their ways.
  Vec3 carried(const Vec3& x, double s) const;

  bool closed() const;
  // True when the closed mesh was wound with its normals inwards; it is turned round on construction.
  bool inside_out() const;
  const TriangleMesh& mesh() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace drape
