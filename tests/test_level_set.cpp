// Laws of the level set: near the exact distance to the mesh it was made of, smooth, signed all through, a
// bound where it is coarse, the same bits on any number of threads.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "mesh/base/threads.h"
#include "mesh/level_set/level_set.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "solver/drape.h"
#include "tests/shapes.h"

#include "tests/places.h"

using namespace drape;
using namespace drape::test;

namespace {

TriangleMesh torus(double ring, double tube, int around, int across) {
  TriangleMesh m;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * pi * i / around, b = 2 * pi * j / across, r = ring + tube * std::cos(b);
      m.positions.push_back({r * std::cos(a), tube * std::sin(b), r * std::sin(a)});
    }
  const auto at = [&](int i, int j) { return i % around * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      m.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return m;
}

TriangleMesh turned(TriangleMesh m) {
  for (Vec3& x : m.positions) x = some_rotation() * x + Vec3(0.013, -0.021, 0.007);
  return m;
}

struct Body {
  const char* name;
  TriangleMesh mesh;
  double voxel;
};

std::vector<Body> bodies() {
  return {{"ball", sphere(4, 0.3), 0.01},
          {"box", turned(box_mesh({0.5, 0.4, 0.3})), 0.01},
          {"torus", torus(0.3, 0.1, 96, 48), 0.01},
          {"body", read_obj(source_dir() + "/data/meshes/body.obj"), 0.006}};
}

Vec3 in_band(const TriangleMesh& mesh, double band, Random& r) {
  return on_mesh(mesh, r) + r(0, band) * r.direction();
}

}  // namespace

TEST_CASE("a level set is within half a voxel of the mesh, and measures that itself", "[level-set]") {
  for (const Body& b : bodies()) {
    INFO(b.name);
    const LevelSet level_set = LevelSet::from_mesh(b.mesh, {.voxel = b.voxel});
    const SurfaceDistance exact(b.mesh);
    CHECK(level_set.band() == Approx(3 * b.voxel));
    Random r;
    double worst = 0, squares = 0;
    constexpr int points = 10000;
    for (int i = 0; i < points; ++i) {
      const Vec3 x = in_band(b.mesh, level_set.band(), r);
      const double off = level_set.closest(x).distance - exact.closest(x).distance;
      worst = std::max(worst, std::abs(off));
      squares += off * off;
    }
    REQUIRE(level_set.error());
    CHECK(worst <= 0.5 * b.voxel);
    CHECK(level_set.error()->largest <= 0.5 * b.voxel);
    CHECK(level_set.error()->largest == Approx(worst).epsilon(0.3));
    CHECK(level_set.error()->rms == Approx(std::sqrt(squares / points)).epsilon(0.6));
    const Vec3 at = level_set.error()->where;
    CHECK(std::abs(level_set.closest(at).distance - exact.closest(at).distance) ==
          level_set.error()->largest);
  }
}

TEST_CASE("a level set converges with the voxel", "[level-set]") {
  // Away from the creases of the distance: the torus is smooth, but for its triangles, which are small.
  const TriangleMesh mesh = torus(0.3, 0.1, 512, 256);
  const SurfaceDistance exact(mesh);
  std::vector<double> worst;
  for (const double voxel : {0.03, 0.02, 0.0133}) {
    const LevelSet level_set = LevelSet::from_mesh(mesh, {.voxel = voxel});
    Random r;
    double largest = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 x = on_mesh(mesh, r) + 0.02 * r.direction();
      largest = std::max(largest, std::abs(level_set.closest(x).distance - exact.closest(x).distance));
    }
    worst.push_back(largest);
  }
  CAPTURE(worst);
  CHECK(worst[0] / worst[1] > 1.5 * 1.5);  // second order at least
  CHECK(worst[1] / worst[2] > 1.5 * 1.5);
  // At the creases of a box: first order.
  const TriangleMesh box = turned(box_mesh({0.5, 0.4, 0.3}));
  std::vector<double> at_edges;
  for (const double voxel : {0.02, 0.01, 0.005})
    at_edges.push_back(LevelSet::from_mesh(box, {.voxel = voxel}).error()->largest);
  CAPTURE(at_edges);
  CHECK(at_edges[0] / at_edges[1] > 1.7);
  CHECK(at_edges[1] / at_edges[2] > 1.7);
}

TEST_CASE("the normal is the slope of the value, of length one, and turns smoothly", "[level-set]") {
  const TriangleMesh mesh = torus(0.3, 0.1, 192, 96);
  const double h = 0.01;
  const LevelSet level_set = LevelSet::from_mesh(mesh, {.voxel = h});
  Random r;
  double length = 0, direction = 0, jump = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 x = in_band(mesh, level_set.band(), r);
    const SurfacePoint p = level_set.closest(x);
    Vec3 slope;
    for (int k = 0; k < 3; ++k)
      slope[k] = (level_set.closest(x + step * Vec3::Unit(k)).distance -
                  level_set.closest(x - step * Vec3::Unit(k)).distance) /
                 (2 * step);
    CHECK(p.normal.norm() == Approx(1).margin(1e-12));
    length = std::max(length, std::abs(slope.norm() - 1));
    direction = std::max(direction, (slope.normalized() - p.normal).norm());
    // The curvature here is at most 1 / 7 cm; a normal that jumped from voxel to voxel would not get smaller.
    const Vec3 beside = level_set.closest(x + 1e-7 * r.direction()).normal;
    jump = std::max(jump, (beside - p.normal).norm());
  }
  CHECK(length < 0.05);
  CHECK(direction < 1e-6);
  CHECK(jump < 1e-5);
}

TEST_CASE("a level set is signed all through and bounds the distance beyond its band", "[level-set]") {
  for (const Body& b : bodies()) {
    INFO(b.name);
    const LevelSet level_set = LevelSet::from_mesh(b.mesh, {.voxel = b.voxel});
    const SurfaceDistance exact(b.mesh);
    const Vec3 middle = 0.5 * (level_set.lower() + level_set.upper()), half = level_set.upper() - middle;
    Random r;
    int inside = 0, outside = 0, descents = 0;
    for (int i = 0; i < 20000; ++i) {
      const double spread = i % 2 ? 1 : 3;
      const Vec3 x = middle + spread * half.cwiseProduct(r.point(1));
      const double d = exact.closest(x).distance;
      const SurfacePoint p = level_set.closest(x);
      CHECK(p.normal.norm() == Approx(1).margin(1e-9));
      if (std::abs(d) > 0.5 * b.voxel) CHECK((p.distance < 0) == (d < 0));
      if (d >= level_set.band()) {
        CHECK(p.distance <= d);
        CHECK(p.distance >= std::min(d - 14 * b.voxel, level_set.band() - 0.5 * b.voxel));
        ++outside;
      }
      if (d < -level_set.band()) {
        CHECK(p.distance == Approx(d).margin(6 * b.voxel));  // at the middle of a ball it is coarse
        ++inside;
        // Out along the normals, in steps as long as a voxel, from any depth.
        Vec3 y = x;
        for (int k = 0; k < 400 && level_set.closest(y).distance < 0; ++k)
          y += b.voxel * level_set.closest(y).normal;
        descents += level_set.closest(y).distance >= 0;
      }
    }
    CHECK(outside > 1000);
    CHECK(inside > 100);
    CHECK(descents >= inside * 0.999);  // where the nearest side is not decided, the steps may go to and fro
  }
  const LevelSet level_set = LevelSet::from_mesh(sphere(2, 0.3));
  CHECK(std::isnan(level_set.closest({0, std::nan(""), 0}).distance));
  CHECK(level_set.closest({1e6, 0, 0}).distance == Approx(1e6).epsilon(1e-6));
}

TEST_CASE("a level set has the same bits twice and on any number of threads", "[level-set]") {
  const TriangleMesh mesh = torus(0.3, 0.1, 48, 24);
  const int before = threads();
  std::vector<LevelSet> made;
  for (const int n : {1, 1, 2, 7}) {
    set_threads(n);
    made.push_back(LevelSet::from_mesh(mesh));
  }
  set_threads(before);
  Random r;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x = r.point(0.6);
    const SurfacePoint p = made[0].closest(x);
    for (const LevelSet& other : made) {
      const SurfacePoint q = other.closest(x);
      REQUIRE((p.distance == q.distance && p.normal == q.normal));
    }
  }
  for (const LevelSet& other : made) CHECK(other.error()->largest == made[0].error()->largest);
}

TEST_CASE("a moved level set is the level set of the moved mesh", "[level-set]") {
  const TriangleMesh mesh = torus(0.3, 0.1, 96, 48);
  const LevelSet moved =
      LevelSet::from_mesh(mesh, {.voxel = 0.01}).moved(some_rotation(), {0.013, -0.021, 0.007});
  const SurfaceDistance exact(turned(mesh));
  Random r;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x = in_band(exact.mesh(), 0.02, r);
    CHECK(moved.closest(x).distance == Approx(exact.closest(x).distance).margin(0.001));
    CHECK((moved.closest(x).normal - exact.closest(x).normal).norm() < 0.1);
  }
}

TEST_CASE("parts too thin for the voxels are noticed", "[level-set]") {
  const TriangleMesh plate = turned(box_mesh({0.5, 0.004, 0.3}));
  const auto thin = LevelSet::from_mesh(plate, {.voxel = 0.01}).error();
  CHECK(thin->vanished > 0.5);
  const SurfaceDistance exact(plate);
  CHECK(std::abs(exact.closest(thin->vanished_where).distance) < 1e-9);
  CHECK(LevelSet::from_mesh(plate, {.voxel = 0.001}).error()->vanished == 0);
  CHECK(LevelSet::from_mesh(box_mesh({0.5, 0.4, 0.3}), {.voxel = 0.01}).error()->vanished == 0);
}

TEST_CASE("a path meets a level set where it meets the ball", "[level-set]") {
  const Shape ball = Sphere{.radius = 0.3};
  const Shape grid =
      LevelSetBody(std::make_shared<const LevelSet>(LevelSet::from_mesh(sphere(5, 0.3), {.voxel = 0.01})));
  CHECK(name(grid) == "level-set");
  CHECK_NOTHROW(check(grid));
  CHECK_THROWS_AS(check(Shape(LevelSetBody())), InputError);
  Random r;
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from = r(0.35, 1.5) * r.direction(), to = r.point(0.8);
    const auto exact = first_hit(ball, from, to, 0.002), found = first_hit(grid, from, to, 0.002);
    const Vec3 way = to - from;
    const double nearest =
        (from - std::clamp(from.dot(from - to) / way.squaredNorm(), 0.0, 1.0) * -way).norm();
    if (std::abs(nearest - 0.302) < 0.005) continue;  // grazing
    REQUIRE(exact.has_value() == found.has_value());
    if (!exact) continue;
    ++met;
    CHECK(closest(ball, from + found->fraction * way).distance == Approx(0.002).margin(0.001));
  }
  CHECK(met > 300);
}

TEST_CASE("a cloth comes to rest on a level set as on the ball", "[level-set]") {
  const auto draped = [](const Shape& shape) {
    TriangleMesh mesh = grid(17, 17, 0.8, 0.8);
    for (Vec3& x : mesh.positions) x += Vec3(0.003, 0.32, 0.002);
    System system(lumped_mass(mesh, 0.15));
    system.add(noh_jung(mesh, {.stretch = 300, .bend = 1e-5, .damping = 0.01}));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = shape, .friction = 0.5});
    ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"), {.tolerance = 1e-6});
    State state = at_rest(mesh);
    for (int k = 0; k < 30; ++k) REQUIRE(stepper.advance(state, 0.01).done);
    return state.x;
  };
  const VecX exact = draped(Sphere{.radius = 0.3});
  const double voxel = 0.01;
  const VecX found = draped(
      LevelSetBody(std::make_shared<const LevelSet>(LevelSet::from_mesh(sphere(5, 0.3), {.voxel = voxel}))));
  double worst = 0, gap = 0;
  for (int i = 0; i < static_cast<int>(exact.size() / 3); ++i) {
    worst = std::max(worst, (exact.segment<3>(3 * i) - found.segment<3>(3 * i)).norm());
    gap = std::max(gap, 0.302 - found.segment<3>(3 * i).norm());
  }
  CHECK(worst < voxel);
  CHECK(gap < 0.1 * voxel);
}
