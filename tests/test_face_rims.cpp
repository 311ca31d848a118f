// Triangles of the cloth over the corners and rims of a box: where they touch, and that they come to rest
// there.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "solver/assembly/assembly.h"
#include "tests/same_bits.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

// Behind a corner or a rim the nearest face of the box changes from one side of the lowest point to the
// other. The box turns by 0.3 rad in the step, and the normal with it.
TEST_CASE("a triangle that cuts off a corner or a rim of a box is pushed straight out", "[faces]") {
  constexpr double h = 0.01;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0, 1), about(-0.125, 0.125);
  for (double size : {0.005, 0.02, 0.08})
    for (int sharp : {2, 3})  // faces of the box that meet there
      for (int k = 0; k < 50; ++k) {
        INFO(size << " m, " << sharp << " faces, " << k);
        Vec3 n = Vec3::Zero();
        for (int c = 0; c < sharp; ++c) n[c] = 0.3 + any(random);
        n.normalize();
        const Vec3 u = n.unitOrthogonal(), w = n.cross(u);
        const double depth = 0.02 * size, turn = 2 * std::numbers::pi * any(random);
        const double along_u = about(random), along_w = about(random);
        const Vec3 middle =
            Vec3(0.05, 0.05, sharp == 3 ? 0.05 : 0.0) - depth * n + size * (along_u * u + along_w * w);
        TriangleMesh one;
        for (int i = 0; i < 3; ++i) {
          const double angle = turn + 2 * std::numbers::pi * i / 3;
          one.positions.push_back(middle + size * (std::cos(angle) * u + std::sin(angle) * w));
        }
        one.triangles = {{0, 1, 2}};
        Constraints constraints;
        constraints.add(Obstacle{.shape = Box{{0, 0, 0}, {0.1, 0.1, 0.1}},
                                 .margin = 0.1 * size,
                                 .motion = Motion::constant(Vec3::Zero(), {0, 30, 0}, Vec3::Zero())});
        constraints.add_faces({{{0, 1, 2}, 500}});
        const State state = at_rest(one);
        const ContactStep step = constraints.begin_step(state.x, state.v, std::vector<double>(3, 0.01), 0, h);
        REQUIRE(step.touching_faces().size() == 1);
        const FaceContact& contact = step.touching_faces()[0];
        CHECK(contact.normal.dot(rotation(0.3, Vec3::UnitY()) * n) > 0.99);
        // The deepest point lies equally far behind the faces that meet there. The search may miss 0.3 of
        // that.
        CHECK(constraints.bodies()[0].distance(contact.place) < -0.7 * depth / n.sum());
      }
}

TEST_CASE("a triangle that cuts a plate, or a blade, is pushed somewhere", "[faces]") {
  for (double thickness : {1e-4, 1e-3, 5e-3})  // m
    for (double tilt : {0.0, 0.01, 0.3, 1.0})
      for (double turn : {0.0, 0.2}) {
        INFO(thickness << " m, tilted by " << tilt << ", turned by " << turn);
        const Mat3 R = rotation(turn, {1, 2, 3}) * rotation(tilt, Vec3::UnitZ());
        TriangleMesh one;
        for (const Vec3& x :
             {Vec3(-0.02, 0.001, -0.01), Vec3(0.021, 0.002, -0.012), Vec3(0.001, 0.0015, 0.02)})
          one.positions.push_back(R * x);
        one.triangles = {{0, 1, 2}};
        Constraints constraints;
        constraints.add(Obstacle{.shape = Box{{0, 0, 0}, {thickness, 0.1, 0.1}, rotation(turn, {1, 2, 3})},
                                 .margin = 2e-3});
        constraints.add_faces({{{0, 1, 2}, 500}});
        const State state = at_rest(one);
        const ContactStep step =
            constraints.begin_step(state.x, state.v, std::vector<double>(3, 0.01), 0, 0.01);
        REQUIRE_FALSE(step.touching_faces().empty());
        for (const FaceContact& contact : step.touching_faces()) CHECK(contact.normal.norm() == Approx(1));
      }
}

namespace {

// A sheet of 30 cm, held along its border, and a box that comes up under it by 2 cm in 0.2 s.
struct DrawnSheet : Assembly {
  DrawnSheet(int n, Kind kind, double turn, const std::string& method) : Assembly({0, -9.81, 0}) {
    constraints->add(Obstacle{.shape = Box{{0, -0.05, 0}, {0.1, 0.1, 0.14}, rotation(turn, {0, 1, 0})},
                              .friction = 0.5,
                              .margin = 2e-3,
                              .motion = Motion::keyframes({{.time = 0, .translate = {0, -0.005, 0}},
                                                           {.time = 0.2, .translate = {0, 0.02, 0}}},
                                                          Vec3::Zero())});
    const TriangleMesh sheet = bent(n, kind, 0.3, [](double, double) { return 0.0; });
    Vec3 half = Vec3::Zero();
    for (const Vec3& x : sheet.positions) half = half.cwiseMax(x.cwiseAbs());
    for (int i = 0; i < sheet.vertex_count(); ++i)
      if (const Vec3 to_border = half - sheet.positions[i].cwiseAbs();
          std::min(to_border[0], to_border[2]) < 0.02)
        constraints->pin(i);
    add({.mesh = sheet,
         .fabric = {.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 0.02},
         .model = ClothModel::woven});
    use(method, "auto", {.tolerance = 1e-6});
  }
  const std::vector<FaceContact>& touching() const { return constraints->faces().touching(); }
};

}  // namespace

TEST_CASE("cloth that is drawn over the corners and rims of a box comes to rest", "[faces]") {
  int pushing = 0, doubled = 0;
  for (int n : {8, 12, 17})
    for (Kind kind : kinds) {
      const double turn = std::array{0.0, 0.3, 0.7}[static_cast<std::size_t>(n + static_cast<int>(kind)) % 3];
      INFO(n << " vertices along an edge, kind " << static_cast<int>(kind) << ", turned by " << turn);
      DrawnSheet sheet(n, kind, turn, "implicit-euler");
      double speed = 0;
      for (int k = 0; k < 300; ++k) {
        REQUIRE(sheet.advance(0.01).done);
        if (k >= 250) speed = std::max(speed, max_speed(sheet.state));
      }
      CHECK(speed < 1e-3);
      for (std::size_t i = 0; i < sheet.touching().size(); ++i) {
        pushing += sheet.touching()[i].push > 0;
        doubled += i > 0 && sheet.touching()[i].face == sheet.touching()[i - 1].face;
      }
    }
  CHECK(pushing > 50);
  CHECK(doubled > 5);
}

TEST_CASE("what a face's contact remembers is its push at the end of the step", "[faces]") {
  for (const std::string& name :
       {std::string("implicit-euler"), std::string("bdf2"), std::string("newton-kinsol")}) {
    DrawnSheet sheet(8, Kind::squares, 0.3, name);
    int pushing = 0;
    for (int k = 0; k < 40; ++k) {
      INFO(name << ", step " << k);
      REQUIRE(sheet.advance(0.01).done);
      for (const FaceContact& c : sheet.touching()) {
        pushing += c.push > 0;
        REQUIRE(c.push == Approx(-c.stiffness * std::min(c.gap_at(sheet.state.x), 0.0)).margin(1e-9));
      }
    }
    CHECK(pushing > 50);
  }
}
