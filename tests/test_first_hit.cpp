// first_hit on thin and grazing cases, and over the list of shapes.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("a thin plate is not stepped over", "[shapes][hit]") {
  const Vec3 size(2, 0.001, 2);
  for (const Shape& plate :
       {Shape(Box{.size = size}), Shape(body(box_mesh(size))), Shape(body(open_sheet()))}) {
    INFO(name(plate));
    for (double margin : {0.0, 0.001, 0.02})
      for (double slant : {0.0, 0.3, 0.9}) {
        const Vec3 x0(-slant * 0.5, 1.5, 0.011), x1(slant * 0.5, -1.5, 0.013);
        const auto hit = first_hit(plate, x0, x1, margin);
        REQUIRE(hit);
        CHECK(std::abs(hit->surface.distance - margin) < 1e-7);
        CHECK(hit->surface.normal.y() == Approx(1));
        const double top =
            std::holds_alternative<MeshBody>(plate) && !std::get<MeshBody>(plate)->closed() ? 0 : 0.0005;
        CHECK(hit->fraction == Approx((1.5 - top - margin) / 3).margin(1e-6));
      }
  }
}

TEST_CASE("a hit lies on the margin and nothing is nearer before it", "[shapes][hit]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    Random r;
    HitLaw law;
    for (int i = 0; i < 300; ++i) {
      const Vec3 x0 = r.point(2);
      const Vec3 x1 =
          i % 2 ? Vec3(x0 + r(0.01, 2) * r.direction()) : Vec3(x0 + r(0.5, 2) * (c.on_surface(r) - x0));
      const double margin = r(0, 0.05);
      law.path(c.shape, x0, x1, margin);
    }
    INFO(law);
    CHECK(law.holds(40));
  }
}

TEST_CASE("sliding just outside the margin is no hit", "[shapes][hit]") {
  const double margin = 0.002;
  const TriangleMesh block = box_mesh({4, 1, 4});
  for (double gap : {1e-6, 1e-4, 1e-2}) {
    const Vec3 x0(-1.5, 0.5 + margin + gap, 0.1), x1(1.5, 0.5 + margin + gap, 0.2);
    CHECK_FALSE(first_hit(Plane{.point = {0, 0.5, 0}}, x0, x1, margin));
    CHECK_FALSE(first_hit(Box{.size = {4, 1, 4}}, x0, x1, margin));
    CHECK_FALSE(first_hit(body(block), x0, x1, margin));
    CHECK_FALSE(
        first_hit(Sphere{.radius = 0.5}, {-1, 0.5 + margin + gap, 0}, {1, 0.5 + margin + gap, 0}, margin));
    CHECK_FALSE(first_hit(Capsule{.radius = 0.5}, {-1, 0.1, 0.5 + margin + gap}, {1, 0.2, 0.5 + margin + gap},
                          margin));
  }
  const auto into =
      first_hit(body(block), {-1.5, 0.5 + margin + 0.01, 0}, {1.5, 0.5 + margin - 0.01, 0}, margin);
  REQUIRE(into);
  CHECK(into->fraction == Approx(0.5).margin(1e-5));
}

TEST_CASE("a start within the margin: away is clear, nearer is a hit at once", "[shapes][hit]") {
  const std::vector<Shape> shapes = {Plane{},
                                     Sphere{.centre = {0, -1, 0}},
                                     Box{.centre = {0, -0.5, 0}},
                                     Capsule{.a = {0, -1, 0}, .b = {1, -1, 0}},
                                     Bowl{.centre = {0, 1, 0}, .radius = 0.98},
                                     body(open_sheet())};
  for (const Shape& shape : shapes) {
    INFO(name(shape));
    const Vec3 x0(0.02, 0.025, 0.01);
    const double phi = closest(shape, x0).distance, margin = phi + 0.01;
    const Vec3 out = x0 + 0.3 * closest(shape, x0).normal, in = x0 - 0.003 * closest(shape, x0).normal;
    CHECK_FALSE(first_hit(shape, x0, out, margin));
    const auto hit = first_hit(shape, x0, in, margin);
    REQUIRE(hit);
    CHECK(hit->fraction == 0);
    CHECK_FALSE(first_hit(shape, x0, x0, margin));
  }
  // Out of the inner side of a bowl and across: away at first, then onto the other side.
  const auto across = first_hit(Bowl{}, {-0.99, -0.01, 0}, {0.99, -0.01, 0}, 0.05);
  REQUIRE(across);
  CHECK(across->fraction > 0.9);
  CHECK(across->surface.normal.x() < -0.9);
}
