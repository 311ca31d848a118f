// Triangles that stand, in embree's tree: which are near a point, which a ray meets first. The one door to
// embree, which works in float, here about a centre; exact answers are made from what it proposes.
#pragma once

#include <memory>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

class TriangleTree {
 public:
  enum class Quality { high, quick };  // of the tree: how long a question takes, or how long the tree

  TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, const Vec3& centre,
               Quality quality = Quality::high);

  // All of these are safe to call from several threads.

  // f(triangle, radius) of every triangle that may be nearer to x than the radius, at first infinite [m]; it
  // returns the radius from then on, never a longer one.
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
    int triangle = -1;            // none
    double distance = 0;          // m where the direction is a unit vector
    Vec3 weights = Vec3::Zero();  // of the triangle's corners
    bool hit() const { return triangle >= 0; }
  };
  Hit first_hit(const Vec3& from, const Vec3& direction) const;
  bool blocked(const Vec3& from, const Vec3& direction, double distance) const;  // anything nearer

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
