// Signed distance from a point to a triangle surface that stands or that moves within a step.
//   closed     negative inside; sign by the angle-weighted pseudo-normal of the closest feature
//              [Baerentzen & Aanaes 2005, Signed distance computation using the angle weighted pseudonormal]
//   otherwise  a thick surface: never negative, the normal points from the surface to the point
//
// Closed: every edge has two triangles and the surface two sides. Each connected piece is wound outwards on
// its own, so that the inner wall of a hollow body counts as a second body.
//
// After move(start, end) every vertex goes straight from its start to its end while s [-] goes from 0 to 1,
// and all questions are about the surface at an s. Which triangles are neighbours and which side is outside
// is the mesh's, as it was constructed.
//
// Distances are computed in double precision by us, and ties go to the lowest triangle number, so the answer
// does not depend on the tree (embree's for what stands, ours for what moves) or on the processor.
#pragma once

#include <memory>
#include <optional>

#include "mesh/triangles/mesh_frames.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct SurfacePoint {
  double distance;  // m, negative inside
  Vec3 normal;      // unit, gradient of the distance: outwards
};

// What the vertices that carry triangles do in a step, all in m and 0 when the surface stands.
struct SurfaceMotion {
  Vec3 mean = Vec3::Zero();  // displacement
  double about_mean = 0;     // the most that the displacement of one differs from the mean
  double largest = 0;        // the most that one moves
};

class SurfaceDistance {
 public:
  explicit SurfaceDistance(const TriangleMesh& mesh);  // throws InputError when no triangle has an area
  ~SurfaceDistance();
  SurfaceDistance(const SurfaceDistance&) = delete;
  SurfaceDistance& operator=(const SurfaceDistance&) = delete;

  // The step: the places of all the mesh's vertices [m]. Throws InputError when there are not as many. Refits
  // the tree; allocates nothing after the first call.
  void move(const std::vector<Vec3>& start, const std::vector<Vec3>& end);
  void move(const MeshFrames& frames, double t0, double t1);  // from where it is at t0 to t1 [s]
  const SurfaceMotion& motion() const;
  double largest_displacement() const { return motion().largest; }

  std::vector<Vec3> vertices(double s) const;  // of the mesh, m

  // All of these are safe to call from several threads.
  SurfacePoint closest(const Vec3& x, double s = 0) const;
  // displacement: of the surface's point closest to x, in the whole step [m].
  SurfacePoint closest(const Vec3& x, double s, Vec3& displacement) const;

  // The first s in [from, 1] at which the straight way from x0 (s = 0) to x1 (s = 1) goes through a triangle,
  // from outside in where the surface is closed. Roots of cubics [mesh/distance/crossing.h]: none is passed over, but
  // what goes along the surface does not go through.
  std::optional<double> first_crossing(const Vec3& x0, const Vec3& x1, double from = 0) const;

  // No triangle comes as near as `margin` [m] to what goes straight from x0 (s = 0) to x1 (s = 1): by where
  // each is at s = 0 and how far the two move against each other. False may be a false alarm.
  bool stays_clear(const Vec3& x0, const Vec3& x1, double margin) const;

  // A point that the surface carries with it, beside its closest triangle.
  struct Anchor {
    Triangle triangle;  // vertices
    Vec3 weights;       // of these: the point of the surface
    Vec3 offset;        // m, from there, along the triangle's first side, across it, and along its normal
  };
  Anchor anchor(const Vec3& x, double s = 0) const;
  Vec3 place(const Anchor& anchor, double s) const;

  bool closed() const;
  bool inside_out() const;  // closed, but wound with normals inwards (it is turned round on construction)
  const TriangleMesh& mesh() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace drape
