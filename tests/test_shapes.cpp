// Laws of the signed distances, over a list of shapes: gradient, eikonal equation, Lipschitz bound, sign,
// zero set, projection.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "mesh/base/errors.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("every kind of shape has a case here, or moves or is a grid", "[shapes]") {
  std::set<std::size_t> kinds = {Shape(DeformingBody()).index(), Shape(LevelSetBody()).index()};
  for (const Case& c : cases()) kinds.insert(c.shape.index());
  CHECK(kinds.size() == std::variant_size_v<Shape>);
}

TEST_CASE("the normal is the unit gradient of the distance", "[shapes]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    Random r;
    int looked = 0;
    double worst = 0, length = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 x = r.point(1.5);
      const SurfacePoint p = closest(c.shape, x);
      length = std::max(length, std::abs(p.normal.norm() - 1));
      if (near_medial_axis(c.shape, x)) continue;
      ++looked;
      Vec3 gradient;
      for (int k = 0; k < 3; ++k) {
        const Vec3 e = step * Vec3::Unit(k);
        gradient[k] = (closest(c.shape, x + e).distance - closest(c.shape, x - e).distance) / (2 * step);
      }
      worst = std::max({worst, (gradient - p.normal).norm(), std::abs(gradient.norm() - 1)});
    }
    CHECK(looked > 480);
    CHECK(length < 1e-14);
    CHECK(worst < 1e-7);
  }
}

TEST_CASE("the distance is zero on the surface, negative inside and falls no faster than 1", "[shapes]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    Random r;
    double surface = 0, foot = 0, slope = 0;
    int wrong = 0;
    for (int i = 0; i < 500; ++i) {
      surface = std::max(surface, std::abs(closest(c.shape, c.on_surface(r)).distance));
      const Vec3 x = r.point(1.5), y = x + r(0, 0.5) * r.direction();
      const SurfacePoint p = closest(c.shape, x);
      wrong += (p.distance < 0) != c.inside(x);
      slope = std::max(slope, std::abs(closest(c.shape, y).distance - p.distance) - (y - x).norm());
      foot = std::max(foot, std::abs(closest(c.shape, x - p.distance * p.normal).distance));
    }
    CHECK(surface < 1e-14);
    CHECK(wrong == 0);
    CHECK(slope < 1e-14);
    CHECK(foot < 1e-14);
  }
}

TEST_CASE("where the normal is not defined a unit one is returned", "[shapes]") {
  const Bowl bowl{};
  const std::vector<std::pair<Shape, Vec3>> places = {
      {Sphere{}, Vec3::Zero()},
      {bowl, bowl.centre},
      {bowl, Vec3(0, 0.4, 0)},
      {bowl, Vec3(0, -1.01, 0)},
      {Box{}, Vec3::Zero()},
      {Box{}, Vec3(0.5, 0.5, 0.5)},
      {Capsule{}, Vec3(0, 0.3, 0)},
      {Capsule{.a = Vec3::Zero(), .b = Vec3::Zero()}, Vec3::Zero()},
      {Plate{}, Vec3::Zero()},
      {Plate{.radius = 1, .height = 3}, Vec3::Zero()},            // on its axis, nearest to the wall
      {Plate{.radius = 1, .height = 2, .rim = 1}, Vec3::Zero()},  // a ball
      {Plate{.radius = 1, .height = 3, .rim = 1}, Vec3::Zero()},  // a capsule
      {Plate{.radius = 2, .height = 1, .rim = 0.5}, Vec3(1, 0, 0)},
      {body(box_mesh(Vec3::Ones())), Vec3::Zero()},
      {body(open_sheet()), Vec3(0.3, 0, 0.1)}};
  for (const auto& [shape, x] : places) {
    INFO(name(shape) << " at " << x.transpose());
    CHECK(std::abs(closest(shape, x).normal.norm() - 1) < 1e-15);
    CHECK(std::isfinite(closest(shape, x).distance));
  }
}

TEST_CASE("sizes that are none are refused by name", "[shapes]") {
  const std::vector<std::pair<Shape, std::string>> bad = {
      {Plane{.normal = Vec3::Zero()}, "normal"},
      {Sphere{.radius = 0}, "radius"},
      {Sphere{.centre = {std::nan(""), 0, 0}}, "centre"},
      {Bowl{.thickness = -1}, "thickness"},
      {Bowl{.axis = Vec3::Zero()}, "axis"},
      {Box{.size = {1, 0, 1}}, "size"},
      {Box{.rotation = 2 * Mat3::Identity()}, "rotation"},
      {Capsule{.radius = std::nan("")}, "radius"},
      {Plate{.height = 0}, "height"},
      {Plate{.rim = -0.001}, "rim"},
      {Plate{.rim = 0.011}, "rim"},
      {Plate{.radius = 0.1, .height = 1, .rim = 0.2}, "rim"},
      {Plate{.rim = std::nan("")}, "rim"},
      {Plate{.axis = Vec3::Zero()}, "axis"},
      {MeshBody{}, "mesh"}};
  for (const auto& [shape, field] : bad) CHECK_THROWS_WITH(check(shape), Catch::Contains(field));
  for (const Case& c : cases()) CHECK_NOTHROW(check(c.shape));
}
