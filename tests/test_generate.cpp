// Laws of the generated meshes: counts, areas, winding, symmetry, sizes of the shape they stand for.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "mesh/base/errors.h"
#include "mesh/obj/examine.h"
#include "mesh/triangles/generate.h"
#include "mesh/triangles/topology.h"

using namespace drape;

namespace {

const double kPi = std::acos(-1.0);

Vec3 normal(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 p = mesh.positions[t[1]] - mesh.positions[t[0]], q = mesh.positions[t[2]] - mesh.positions[t[0]];
  return Vec3(p.y() * q.z() - p.z() * q.y(), p.z() * q.x() - p.x() * q.z(), p.x() * q.y() - p.y() * q.x()) /
         2;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
  return sum;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += mesh.positions[t[0]].dot(normal(mesh, t)) / 3;
  return sum;
}

Vec3 middle(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : mesh.positions) sum += x;
  return sum / mesh.vertex_count();
}

const std::vector<Eigen::Vector2d> spindle = {{0, -1}, {0.5, 0}, {0, 1}};

void check_closed(const TriangleMesh& mesh) {
  const MeshReport report = examine(mesh);
  std::string defects;
  for (const Defect& defect : report.defects) defects += format(defect) + "\n";
  INFO(defects);
  CHECK(report.defects.empty());
  CHECK(report.closed);
  CHECK(report.pieces == 1);
}

}  // namespace

TEST_CASE("generated meshes have no defects", "[generate]") {
  for (const TriangleMesh& mesh :
       {grid(2, 2, 1, 1), grid(9, 4, 1, 0.5), equilateral_sheet(5, 6, 0.1), disc(4, 0.5), sphere(0, 1),
        sphere(3, 0.2), tube(3, 2, 0.1, 1), tube(12, 5, 0.1, 1), box({1, 0.2, 3}), turned(spindle, 5)}) {
    const MeshReport report = examine(mesh);
    for (const Defect& defect : report.defects) INFO(format(defect));
    CHECK(report.defects.empty());
    CHECK(report.pieces == 1);
    CHECK(mesh.document == nullptr);
    CHECK(middle(mesh).norm() < 1e-14);
    for (const Edge& e : edges(mesh)) CHECK((e.triangles == 1 || e.forward == 1));
  }
}

TEST_CASE("a grid fills its rectangle and looks up", "[generate]") {
  const TriangleMesh mesh = grid(7, 4, 3, 0.6);
  CHECK(mesh.vertex_count() == 28);
  CHECK(mesh.triangle_count() == 2 * 6 * 3);
  CHECK(area(mesh) == Approx(1.8));
  CHECK(mesh.positions[0] == Vec3(-1.5, 0, -0.3));
  CHECK(mesh.positions[1].x() == Approx(-1.0));  // x fastest
  CHECK(mesh.positions[27] == Vec3(1.5, 0, 0.3));
  for (const Triangle& t : mesh.triangles) {
    CHECK(normal(mesh, t).y() == Approx(0.05));
    CHECK(normal(mesh, t).x() == 0);
  }
  // Union jack: vertices have eight edges and four in turn.
  std::vector<int> degree(28, 0);
  for (const Edge& e : edges(mesh)) ++degree[e.a], ++degree[e.b];
  for (int k = 1; k < 3; ++k) {
    for (int i = 1; i < 6; ++i) CHECK(degree[k * 7 + i] == ((i + k) % 2 == 0 ? 8 : 4));
  }
}

TEST_CASE("an equilateral sheet has one edge length only", "[generate]") {
  const TriangleMesh mesh = equilateral_sheet(6, 5, 0.2);
  CHECK(mesh.vertex_count() == 30);
  CHECK(mesh.triangle_count() == 2 * 5 * 4);
  for (const Edge& e : edges(mesh)) CHECK((mesh.positions[e.a] - mesh.positions[e.b]).norm() == Approx(0.2));
  for (const Triangle& t : mesh.triangles) CHECK(normal(mesh, t).y() == Approx(std::sqrt(3.0) / 4 * 0.04));
}

TEST_CASE("a disc closes on itself and looks up", "[generate]") {
  for (const int rings : {1, 2, 5, 40}) {
    const TriangleMesh mesh = disc(rings, 0.5);
    CHECK(mesh.vertex_count() == 1 + 3 * rings * (rings + 1));
    CHECK(mesh.triangle_count() == 6 * rings * rings);
    const int rim = 6 * rings;  // a polygon of so many corners
    CHECK(area(mesh) == Approx(rim * 0.125 * std::sin(2 * kPi / rim)));
    const std::vector<std::vector<int>> loops = boundary_loops(mesh);
    REQUIRE(loops.size() == 1);
    CHECK(static_cast<int>(loops[0].size()) == rim);
    for (const int v : loops[0]) CHECK(mesh.positions[v].norm() == Approx(0.5));
    for (const Triangle& t : mesh.triangles) CHECK(normal(mesh, t).y() > 0);
  }
}

TEST_CASE("a sphere is closed, looks out and comes closer to the true one", "[generate]") {
  double error = 1;
  for (int level = 0; level <= 4; ++level) {
    const TriangleMesh mesh = sphere(level, 2);
    CHECK(mesh.vertex_count() == 10 * (1 << (2 * level)) + 2);
    CHECK(mesh.triangle_count() == 20 * (1 << (2 * level)));
    for (const Vec3& x : mesh.positions) CHECK(x.norm() == Approx(2).epsilon(1e-14));
    for (const Triangle& t : mesh.triangles) CHECK(normal(mesh, t).dot(mesh.positions[t[0]]) > 0);
    CHECK(examine(mesh).closed);
    const double now = 1 - volume(mesh) / (4.0 / 3 * kPi * 8);
    CHECK(now > 0);
    CHECK(now < error * (level > 1 ? 0.27 : 0.5));  // second order: a quarter of the error each time
    error = now;
  }
}

TEST_CASE("a tube is open at its two ends and looks out", "[generate]") {
  const TriangleMesh mesh = tube(9, 4, 0.3, 1.2);
  CHECK(mesh.vertex_count() == 36);
  CHECK(mesh.triangle_count() == 2 * 9 * 3);
  CHECK(area(mesh) == Approx(9 * 2 * 0.3 * std::sin(kPi / 9) * 1.2));
  for (const Triangle& t : mesh.triangles) {
    CHECK(normal(mesh, t).dot(Vec3(1, 0, 1).cwiseProduct(mesh.positions[t[0]])) > 0);
  }
  for (const auto& loop : boundary_loops(mesh)) {
    for (const int v : loop) CHECK(std::abs(mesh.positions[v].y()) == 0.6);
  }
}

TEST_CASE("a box has eight corners and fills its edges", "[generate]") {
  const TriangleMesh mesh = box({1, 0.2, 3});
  check_closed(mesh);
  CHECK(mesh.vertex_count() == 8);
  CHECK(volume(mesh) == Approx(0.6));
  CHECK(area(mesh) == Approx(2 * (0.2 + 0.6 + 3)));
  for (const Vec3& x : mesh.positions) CHECK(x.cwiseAbs() == Vec3(0.5, 0.1, 1.5));
}

TEST_CASE("turned bodies are closed, look out and come closer to the true ones", "[generate]") {
  double capsule_error = 1, bowl_error = 1;
  for (const int around : {12, 24, 48, 96}) {
    const TriangleMesh rod = capsule(around, 0.3, 1.5), shell = bowl(around, 0.5, 0.1);
    check_closed(rod);
    check_closed(shell);
    const double capsule_now = 1 - volume(rod) / (kPi * 0.09 * 1.5 + 4.0 / 3 * kPi * 0.027);
    // Half of a thick shell, and half a torus of the rim above it.
    const double whole = 2.0 / 3 * kPi * (0.216 - 0.125) + kPi * kPi * 0.55 * 0.0025;
    const double bowl_now = std::abs(1 - volume(shell) / whole);
    CHECK(capsule_now > 0);
    CHECK(capsule_now < (around > 12 ? 0.27 : 0.1) * capsule_error);  // second order
    CHECK(bowl_now < (around > 12 ? 0.6 : 0.3) * bowl_error);         // the rim keeps its pieces
    capsule_error = capsule_now;
    bowl_error = bowl_now;
  }
  CHECK(capsule_error < 0.002);
  CHECK(bowl_error < 0.005);
  check_closed(capsule(8, 0.3, 0));  // a ball: the middle ring is there once
  for (const Vec3& x : capsule(8, 0.3, 0).positions) CHECK(x.norm() == Approx(0.3));
}

TEST_CASE("sizes that make no mesh are refused", "[generate]") {
  CHECK_THROWS_AS(grid(1, 5, 1, 1), InputError);
  CHECK_THROWS_AS(grid(5, 5, 0, 1), InputError);
  CHECK_THROWS_AS(grid(5, 5, 1, NAN), InputError);
  CHECK_THROWS_AS(equilateral_sheet(5, 1, 1), InputError);
  CHECK_THROWS_AS(disc(0, 1), InputError);
  CHECK_THROWS_AS(sphere(-1, 1), InputError);
  CHECK_THROWS_AS(sphere(2, -1), InputError);
  CHECK_THROWS_AS(tube(2, 2, 1, 1), InputError);
  CHECK_THROWS_AS(box({1, 0, 1}), InputError);
  CHECK_THROWS_AS(turned({{0.1, -1}, {0.5, 0}, {0, 1}}, 5), InputError);
  CHECK_THROWS_AS(turned({{0, -1}, {0, 0}, {0, 1}}, 5), InputError);
  CHECK_THROWS_AS(turned(spindle, 2), InputError);
  CHECK_THROWS_AS(capsule(6, 1, 1), InputError);
  CHECK_THROWS_AS(capsule(8, 1, -1), InputError);
  CHECK_THROWS_AS(bowl(8, 1, 0), InputError);
}
