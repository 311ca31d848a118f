// Ropes for the laws of tests/test_rope*.cpp.
#pragma once

#include "solver/assembly/assembly.h"
#include "tests/integrators.h"

namespace drape::test {

inline std::vector<Vec3> straight(const Vec3& from, const Vec3& to, int segments) {
  std::vector<Vec3> points;
  for (int k = 0; k <= segments; ++k) points.push_back(from + (to - from) * k / segments);
  return points;
}

struct Rope : Assembly {
  explicit Rope(std::vector<Vec3> points, const RopeMaterial& material, const Vec3& gravity = {0, -9.81, 0})
      : Assembly(gravity), start(points) {
    add(RopePart{.points = std::move(points), .material = material});
  }

  std::vector<Vec3> start;  // its points [m]

  int count() const { return cloths[0].mesh.vertex_count(); }
  Vec3 at(int k) const { return state.x.segment<3>(3 * k); }
  void hold(std::vector<int> points) { pin(PinVertices{std::move(points)}); }
  // N, of the segment that begins at point k, pushed where negative.
  double tension(int k) const {
    const RestEdge& e = cloths[0].edges[static_cast<std::size_t>(k)];
    return cloths[0].rope->stretch * ((at(e.j) - at(e.i)).norm() / e.L - 1);
  }
  void go(double h, int steps) {
    for (int n = 0; n < steps; ++n) {
      const StepReport report = advance(h);
      INFO("step " << n << ": " << report.failure.what);
      REQUIRE(report.done);
    }
  }
  // To where it hangs: long steps of implicit Euler take what moves away.
  void settle(double h = 0.1, const StepOptions& options = precise()) {
    use("implicit-euler", "eigen-ldlt", options);
    for (int n = 0; n < 2000; ++n) {
      go(h, 1);
      if (state.v.cwiseAbs().maxCoeff() < 1e-9) return;
    }
    FAIL("it does not come to rest: " << state.v.cwiseAbs().maxCoeff() << " m/s");
  }
};

}  // namespace drape::test
