// A surface that moves within a step: the same answers as a surface made anew from where its vertices are.
#include <algorithm>
#include <catch2/catch.hpp>

#include "mesh/base/errors.h"
#include "mesh/base/threads.h"
#include "mesh/triangles/generate.h"
#include "tests/allocations.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

namespace {

using Places = std::vector<Vec3>;

// Turned, bent and carried off, the more the later.
Places bent(const Places& rest, double t) {
  Places places = rest;
  for (Vec3& x : places) {
    const Mat3 turn = Eigen::AngleAxisd(0.4 * t + 0.3 * t * x.y(), Vec3::UnitY()).toRotationMatrix();
    x = turn * x + Vec3(0.3 * t, 0.1 * t * std::sin(2 * x.x()), -0.2 * t);
  }
  return places;
}

TriangleMesh at(const TriangleMesh& mesh, const Places& start, const Places& end, double s) {
  TriangleMesh between = mesh;
  for (std::size_t i = 0; i < start.size(); ++i) between.positions[i] = start[i] + s * (end[i] - start[i]);
  return between;
}

TriangleMesh spiky() {
  TriangleMesh star = lat_long_sphere(12, 15, 1, Vec3::Zero());
  for (int i = 0; i < star.vertex_count(); ++i) star.positions[i] *= i % 2 ? 0.5 : 1.0;
  return star;
}

std::vector<TriangleMesh> meshes() {
  TriangleMesh cup = sphere(2, 0.7);
  cup.triangles.erase(cup.triangles.begin(), cup.triangles.begin() + 40);
  return {sphere(3, 0.8), spiky(), box_mesh({1, 0.7, 0.4}), cup, tube(12, 9, 0.4, 1), open_sheet()};
}

// A place near the surface, at all scales, or anywhere about it.
Vec3 somewhere(const TriangleMesh& mesh, Random& r, int i) {
  if (i % 3 == 0) return on_mesh(mesh, r) + std::pow(10, r(-6, -1)) * r.direction();
  if (i % 3 == 1)
    return mesh.positions[r.below(mesh.vertex_count())] + std::pow(10, r(-6, 0)) * r.direction();
  return r.point(2);
}

void same_as_made_anew(const SurfaceDistance& surface, const TriangleMesh& now, double s, int points) {
  const SurfaceDistance anew(now);
  REQUIRE(anew.closed() == surface.closed());
  Random r;
  double distance = 0, normal = 0;
  for (int i = 0; i < points; ++i) {
    const Vec3 x = somewhere(now, r, i);
    const SurfacePoint p = surface.closest(x, s), q = anew.closest(x);
    distance = std::max(distance, std::abs(p.distance - q.distance));
    normal = std::max(normal, (p.normal - q.normal).norm());
  }
  CHECK(distance < 1e-12);
  CHECK(normal < 1e-9);
}

}  // namespace

TEST_CASE("at every s a moving surface answers as one made anew from its vertices", "[moving]") {
  for (const TriangleMesh& mesh : meshes()) {
    SurfaceDistance surface(mesh);
    for (double t : {0.0, 1.0, 0.5, 3.0, 3.0}) {
      const Places start = bent(mesh.positions, t), end = bent(mesh.positions, t + 0.3);
      surface.move(start, end);
      for (double s : {0.0, 0.31, 0.77, 1.0}) same_as_made_anew(surface, at(mesh, start, end, s), s, 400);
    }
  }
}

TEST_CASE("many moves later the tree finds what a fresh one finds, to the last bit", "[moving]") {
  const TriangleMesh mesh = spiky();
  SurfaceDistance surface(mesh), fresh(mesh);
  for (int k = 0; k < 100; ++k)
    surface.move(bent(mesh.positions, 0.1 * k), bent(mesh.positions, 0.1 * k + 0.1));
  const Places start = bent(mesh.positions, 9.9), end = bent(mesh.positions, 10);
  surface.move(start, end);
  fresh.move(start, end);
  Random r;
  const TriangleMesh now = at(mesh, start, end, 0.6);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 x = somewhere(now, r, i);
    const SurfacePoint p = surface.closest(x, 0.6), q = fresh.closest(x, 0.6);
    REQUIRE(p.distance == q.distance);
    REQUIRE(p.normal == q.normal);
  }
}

TEST_CASE("a surface moved back to its mesh stands as before, to the last bit", "[moving]") {
  const TriangleMesh mesh = spiky();
  SurfaceDistance moved(mesh);
  const SurfaceDistance plain(mesh);
  moved.move(mesh.positions, bent(mesh.positions, 1));
  CHECK(moved.largest_displacement() > 0.1);
  moved.move(mesh.positions, mesh.positions);
  CHECK(moved.largest_displacement() == 0);
  Random r;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x = somewhere(mesh, r, i);
    const SurfacePoint p = moved.closest(x, 0.4), q = plain.closest(x);
    REQUIRE(p.distance == q.distance);
    REQUIRE(p.normal == q.normal);
  }
}

TEST_CASE("what moves is told: largest, mean, and of the closest point", "[moving]") {
  const TriangleMesh mesh = sphere(2, 0.5);
  SurfaceDistance surface(mesh);
  const Places end = bent(mesh.positions, 0.2);
  surface.move(mesh.positions, end);
  double largest = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    largest = std::max(largest, (end[v] - mesh.positions[v]).norm());
  CHECK(surface.largest_displacement() == Approx(largest).epsilon(1e-14));
  CHECK(surface.motion().mean.norm() <= largest);
  // The distance changes with s as the displacement of the closest point says.
  Random r;
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    const double s = r(0.1, 0.9), ds = 1e-6;
    const Vec3 x = on_mesh(mesh, r) + r(0.05, 0.2) * r.direction();
    Vec3 displacement;
    const SurfacePoint p = surface.closest(x, s, displacement);
    if (p.distance < 0) continue;  // the middle of the sphere is near its medial axis
    const double rate =
        (surface.closest(x, s + ds).distance - surface.closest(x, s - ds).distance) / (2 * ds);
    worst = std::max(worst, std::abs(rate + p.normal.dot(displacement)));
  }
  CHECK(worst < 1e-6);
}

TEST_CASE("places of another number are refused", "[moving]") {
  SurfaceDistance surface(box_mesh(Vec3::Ones()));
  const Places eight = box_mesh(Vec3::Ones()).positions;
  CHECK_THROWS_WITH(surface.move(eight, Places(7, Vec3::Zero())),
                    Catch::Contains("8 vertices") && Catch::Contains("7 places"));
  CHECK_THROWS_AS(surface.move(Places(9, Vec3::Zero()), eight), InputError);
  MeshFrames frames;
  frames.add(0, Places(5, Vec3::Zero()));
  CHECK_THROWS_AS(surface.move(frames, 0, 1), InputError);
}

TEST_CASE("a body moved rigidly carries its anchors rigidly, off the surface, too", "[moving]") {
  for (const TriangleMesh& mesh : meshes()) {
    SurfaceDistance surface(mesh);
    const Vec3 way(0.3, -0.2, 0.5);
    Places end = mesh.positions;
    for (Vec3& x : end) x = some_rotation() * x + way;
    surface.move(mesh.positions, end);
    Random r;
    double kept = 0, carried = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 x = somewhere(mesh, r, i);
      const SurfaceDistance::Anchor anchor = surface.anchor(x, 0);
      kept = std::max(kept, (surface.place(anchor, 0) - x).norm());
      carried = std::max(carried, (surface.place(anchor, 1) - (some_rotation() * x + way)).norm());
    }
    CHECK(kept < 1e-12);
    CHECK(carried < 1e-11);
  }
}

TEST_CASE("an anchor on a surface that stretches stays at its place of the triangle", "[moving]") {
  const TriangleMesh sheet = open_sheet();
  SurfaceDistance surface(sheet);
  Places end = sheet.positions;
  for (Vec3& x : end) x = Vec3(2 * x.x(), x.y() + 1, 3 * x.z());
  surface.move(sheet.positions, end);
  const Vec3 x(0.25, 0.1, -0.5);
  CHECK((surface.place(surface.anchor(x), 1) - Vec3(0.5, 1.1, -1.5)).norm() < 1e-14);
  CHECK((surface.place(surface.anchor(x), 0.5) - Vec3(0.375, 0.6, -1)).norm() < 1e-14);
}

TEST_CASE("a triangle that loses its area on the way leaves the answers to its neighbours", "[moving]") {
  const TriangleMesh box = box_mesh(Vec3::Ones());
  SurfaceDistance surface(box);
  Places flat = box.positions;
  for (Vec3& x : flat) x.y() = 0;  // of no thickness at s = 1, its sides without an area
  surface.move(box.positions, flat);
  CHECK(std::abs(surface.closest({0.1, 0.3, 0.2}, 1).distance) == Approx(0.3).epsilon(1e-14));
  CHECK(surface.closest({0.1, 0.3, 0.2}, 0.9).distance == Approx(0.25).epsilon(1e-12));
  for (Vec3& x : flat) x.setZero();  // nothing is left
  surface.move(box.positions, flat);
  CHECK(std::abs(surface.closest({0, 0.3, 0}, 1).distance) == Approx(0.3));
  CHECK(surface.closest({0, 0.3, 0}, 1).normal.allFinite());
}

TEST_CASE("a move after the first one allocates nothing", "[moving]") {
  if (!counts_allocations()) return;
  const TriangleMesh mesh = sphere(3, 0.5);
  SurfaceDistance surface(mesh);
  MeshFrames frames;
  for (int k = 0; k < 4; ++k) frames.add(0.1 * k, bent(mesh.positions, k));
  surface.move(frames, 0, 0.05);
  const long before = allocations();
  double sum = 0;
  for (int k = 0; k < 20; ++k) {
    surface.move(frames, 0.01 * k, 0.01 * k + 0.01);
    sum += surface.closest({1, 0, 0}, 0.5).distance;
    sum += surface.place(surface.anchor({1, 0, 0}, 0), 1).x();
    sum += surface.first_crossing({1, 0, 0}, {0, 0, 0}).value_or(0);
  }
  CHECK(allocations() == before);
  CHECK(std::isfinite(sum));
}

TEST_CASE("the answers do not depend on the number of threads", "[moving]") {
  const TriangleMesh mesh = spiky();
  const Places end = bent(mesh.positions, 1);
  constexpr int points = 4000;
  std::vector<Vec3> first;
  for (int count : {1, 2, 7}) {
    set_threads(count);
    SurfaceDistance surface(mesh);
    surface.move(mesh.positions, end);
    std::vector<Vec3> found(points);
    struct Context {
      const SurfaceDistance& surface;
      std::vector<Vec3>& found;
    } context{surface, found};
    run_in_parallel(
        points,
        [](const void* given, int k) {
          const auto& c = *static_cast<const Context*>(given);
          Random r{std::mt19937(static_cast<unsigned>(k))};
          const SurfacePoint p = c.surface.closest(r.point(1.5), r(0, 1));
          c.found[k] = p.distance * p.normal;
        },
        &context);
    if (first.empty()) first = found;
    CHECK(found == first);
  }
  set_threads(1);
}
