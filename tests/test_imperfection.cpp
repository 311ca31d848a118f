// A cloth that is exactly flat and pushed in its own plane leaves it where it should, and nowhere else.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/base/errors.h"
#include "solver/assembly/assembly.h"
#include "solver/assembly/imperfection.h"
#include "solver/system/measure.h"
#include "tests/strips.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double B = 1e-5, Y = 500;  // N m, N/m

// A sheet of 30 cm that stands upright in the plane z = 0, with its lower edge at y = 0.
TriangleMesh upright_sheet() {
  TriangleMesh mesh = grid(13, 13, 0.3, 0.3);
  double lowest = 1e9;
  for (Vec3& x : mesh.positions) {
    x = Vec3(x.x(), -x.z(), 0);
    lowest = std::min(lowest, x.y());
  }
  for (Vec3& x : mesh.positions) x.y() -= lowest;
  return mesh;
}

// How far the cloth is out of the plane z = 0 after so many steps of 10 ms on a ball below it.
double out_of_plane_on_a_ball(ClothPart part, int steps, std::string* hash = nullptr) {
  Assembly all;
  all.add(std::move(part));
  all.constraints->add(
      Obstacle{.shape = Sphere{.centre = {0.01, -0.105, 0}, .radius = 0.1}, .friction = 0.3});
  all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-6});
  for (int step = 0; step < steps; ++step) REQUIRE(all.advance(0.01).done);
  if (hash) *hash = state_hash(all.state);
  double farthest = 0;
  for (int i = 0; i < all.state.particles(); ++i)
    farthest = std::max(farthest, std::abs(all.state.x[3 * i + 2]));
  return farthest;
}

// The largest deflection of a strip that is clamped at both ends and shortened to `load` times what buckles
// it.
double deflection(StripMesh kind, double load, double amplitude, double length = 0.1) {
  Strip s = strip(kind, 20, 4, length);
  double last = -1;
  for (const Vec3& x : s.mesh.positions) last = std::max(last, x.x());
  const double h = length / 19.5,
               span = last - 0.5 * h;  // the other clamp is half a cell before the end as well
  const double critical = 4 * M_PI * M_PI * B / (span * span);  // N/m                        [Euler]
  TriangleMesh start = s.mesh;
  for (Vec3& x : start.positions) x.x() *= 1 - load * critical / Y;
  Assembly all({0, 0, 0});
  Fabric fabric{.area_density = 0.15, .stretch = Y, .bend = B};
  fabric.weave.poisson = 0;  // a strip that is wide beside its thickness and free to widen
  all.add(ClothPart{.mesh = start,
                    .rest = s.mesh,
                    .fabric = fabric,
                    .model = ClothModel::woven,
                    .imperfection = amplitude});
  std::vector<int> held = s.clamped;
  for (int i = 0; i < s.mesh.vertex_count(); ++i)
    if (s.mesh.positions[static_cast<std::size_t>(i)].x() > last - 1.01 * h) held.push_back(i);
  all.constraints->pin(held);
  all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-8});
  for (int step = 0; step < 200; ++step) REQUIRE(all.advance(0.05).done);
  double largest = 0;
  for (int i = 0; i < all.state.particles(); ++i)
    largest = std::max(largest, std::abs(all.state.x[3 * i + 1]));
  return largest;
}

}  // namespace

TEST_CASE("an upright woven sheet that is lowered on a ball leaves its plane, with the same bits each time",
          "[woven][imperfection]") {
  const ClothPart sheet{.mesh = upright_sheet(), .model = ClothModel::woven};
  std::string once, again;
  CHECK(out_of_plane_on_a_ball(sheet, 60, &once) > 0.03);
  out_of_plane_on_a_ball(sheet, 60, &again);
  CHECK(once == again);
  ClothPart perfect = sheet;
  perfect.imperfection = 0;
  CHECK(out_of_plane_on_a_ball(perfect, 60) == 0);
}

TEST_CASE("a strip that is pushed buckles above Euler's load and not below it", "[woven][imperfection]") {
  for (StripMesh kind : {StripMesh::square, StripMesh::irregular}) {
    INFO(name(kind));
    const double below = deflection(kind, 0.9, woven_imperfection),
                 above = deflection(kind, 1.2, woven_imperfection);
    INFO(below << " m below, " << above << " m above");
    CHECK(below < 12 * woven_imperfection);
    CHECK(above > 1e-4);
    CHECK(deflection(kind, 1.2, 0) == 0);
  }
}

TEST_CASE("an imperfection is small, smooth, and the same on every mesh and wherever the cloth is placed",
          "[imperfection]") {
  const TriangleMesh coarse = grid(9, 9, 0.4, 0.4), fine = grid(17, 17, 0.4, 0.4);
  const std::vector<Vec3> few = imperfection(coarse, coarse, 1e-6), many = imperfection(fine, fine, 1e-6);
  double largest = 0;
  for (std::size_t i = 0; i < few.size(); ++i) {
    largest = std::max(largest, few[i].norm());
    CHECK(std::abs(few[i].y()) == few[i].norm());
    CHECK((few[i] - many[i / 9 * 34 + i % 9 * 2]).norm() < 1e-18);
  }
  CHECK(largest <= 1e-6);
  CHECK(largest > 3e-7);

  TriangleMesh placed = coarse;
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& x : placed.positions) x = turn * x + Vec3(5, -3, 2);
  const std::vector<Vec3> there = imperfection(placed, coarse, 1e-6);
  for (std::size_t i = 0; i < few.size(); ++i) CHECK((there[i] - turn * few[i]).norm() < 1e-12);

  Assembly all;
  CHECK_THROWS_WITH(all.add(ClothPart{.mesh = coarse, .imperfection = -1e-6}),
                    Catch::Contains("cloth: imperfection") && Catch::Contains("not negative"));
  all.add(ClothPart{.mesh = coarse});  // springs: as it is
  CHECK(all.state.x == stacked(coarse.positions));
}
