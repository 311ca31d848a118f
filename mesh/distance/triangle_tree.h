// Triangles at rest in Embree's tree, which answers which of them are near a point and which one a ray meets
// first. Only this file and its .cpp know Embree. Embree works in float, here relative to a centre, so it
// only proposes triangles, and exact answers are computed from its proposals.
#pragma once

#include <memory>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

class TriangleTree {
 public:
  enum class Quality { high, quick };  // how fast questions are, or how fast the tree

  TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const Vec3& centre,
               Quality quality = Quality::high);

  // All functions below may be called from several threads at once.

  // Calls f(triangle, radius) for every triangle that may be nearer to x than the radius [m], which is
  // infinite at first. f returns the radius from then on, never a longer one.
  template <class F>
  void near(const Vec3& x, F& f) const {
    visit(
        x,
        [](void* context, int triangle, float radius) {
          return (*static_cast<F*>(context))(triangle, radius);
        },
        &f);
  }

  struct Hit {
    int triangle = -1;            // -1: the ray meets none
    double distance = 0;          // in m if the direction is a unit vector
    Vec3 weights = Vec3::Zero();  // barycentric weights of the corners
    bool hit() const { return triangle >= 0; }
  };
  Hit first_hit(const Vec3& from, const Vec3& direction) const;
  bool blocked(const Vec3& from, const Vec3& direction, double distance) const;  // by a nearer triangle

 private:
  void visit(const Vec3& x, float (*f)(void* context, int triangle, float radius), void* context) const;

  struct Embree;
  struct Release {
    void operator()(Embree* embree) const;
  };
  std::unique_ptr<Embree, Release> embree_;
  Vec3 centre_;
};

}  // namespace drape
