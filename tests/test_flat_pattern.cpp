// The rest shape of a flat pattern: connections where it is whole, cut, gathered or folded onto itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "mesh/obj/obj.h"
#include "mesh/pattern/flat_pattern.h"
#include "mesh/triangles/generate.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/noh_jung.h"
#include "solver/system/system.h"
#include "tests/garment.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

// By the ends, however the list is ordered.
template <class Connection>
std::map<std::pair<int, int>, Connection> by_ends(const std::vector<Connection>& all) {
  std::map<std::pair<int, int>, Connection> map;
  for (const Connection& c : all) map.emplace(std::minmax(c.i, c.j), c);
  return map;
}

}  // namespace

TEST_CASE("a cloth laid out as its pattern has no energy, and elsewhere what the pattern says", "[sewing]") {
  for (bool quads : {false, true}) {
    const TriangleMesh mesh = parse_obj(TwoPanels{.quads = quads}.obj(), "flat.obj");
    const TriangleMesh flat = flat_pattern(mesh);
    REQUIRE(flat.triangles.size() == mesh.triangles.size());
    TriangleMesh wide = mesh;
    for (Vec3& x : wide.positions) x[0] *= 1.1;
    for (const TriangleMesh* shape : {&std::as_const(mesh), &std::as_const(wide)}) {
      System system(lumped_mass(*shape, flat, 0.2));
      CHECK(std::accumulate(system.masses().begin(), system.masses().end(), 0.0) == Approx(0.2 * 0.4));
      system.add(forces_of(noh_jung_connections(*shape, flat, {}), {}));
      CHECK(system.elastic_energy(stacked(mesh.positions)) < 1e-10);  // six decimals in the file
      CHECK(system.elastic_energy(stacked(wide.positions)) > 0.1);
    }
    const TriangleMesh larger = flat_pattern(mesh, 2);
    CHECK(triangle_area(larger, larger.triangles[0]) == Approx(4 * triangle_area(flat, flat.triangles[0])));
  }
}

TEST_CASE("where the pattern is cut the cloth is joined as if it were not", "[sewing]") {
  const TriangleMesh whole = grid(8, 7, 0.4, 0.25);  // its triangles lean to either side
  TriangleMesh cut;                                  // every triangle by itself, moved and turned as it likes
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    const double angle = 0.7 * static_cast<double>(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = whole.positions[whole.triangles[t][k]];
      cut.positions.emplace_back(std::cos(angle) * x.x() - std::sin(angle) * x.z() + angle, 0,
                                 std::sin(angle) * x.x() + std::cos(angle) * x.z());
    }
    const int first = static_cast<int>(3 * t);
    cut.triangles.push_back({first, first + 1, first + 2});
  }
  const Fabric fabric{.stretch = 700, .bend = 2e-5};
  const Connections as_whole = noh_jung_connections(whole, whole, fabric),
                    as_cut = noh_jung_connections(whole, cut, fabric);
  const auto stretch = by_ends(as_whole.stretch);
  const auto bend = by_ends(as_whole.bend);
  REQUIRE(as_cut.stretch.size() == stretch.size());
  REQUIRE(as_cut.bend.size() == bend.size());
  for (const auto& [ends, s] : by_ends(as_cut.stretch)) {
    CHECK(s.L == Approx(stretch.at(ends).L));
    CHECK(s.k == Approx(stretch.at(ends).k));
  }
  for (const auto& [ends, b] : by_ends(as_cut.bend)) {
    CHECK(b.L == Approx(bend.at(ends).L));
    CHECK(b.k_b == Approx(bend.at(ends).k_b));
    CHECK(b.clamp_k2 == Approx(bend.at(ends).clamp_k2));
  }
}

TEST_CASE("two sides of different lengths are two springs side by side, of the same stiffness together",
          "[sewing]") {
  TriangleMesh pair, rest;
  pair.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}};
  pair.triangles = {{0, 1, 2}, {1, 0, 3}};
  rest.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0, 0, 0}, {1.2, 0, 0}, {0.6, -1, 0}};
  rest.triangles = {{0, 1, 2}, {4, 3, 5}};
  const Connections c = noh_jung_connections(pair, rest, {.stretch_spring = 100});
  double k = 0;
  std::vector<double> lengths;
  for (const StretchConnection& s : c.stretch)
    if (std::minmax(s.i, s.j) == std::pair<const int&, const int&>(0, 1)) {
      k += s.k;
      lengths.push_back(s.L);
    }
  CHECK(k == Approx(100));
  REQUIRE(lengths.size() == 2);
  CHECK(lengths[0] == Approx(1));
  CHECK(lengths[1] == Approx(1.2));
  REQUIRE(c.bend.size() == 1);
  CHECK(c.bend[0].L == Approx(2));  // unfolded, middle on middle
}

TEST_CASE("a rest shape folded onto itself in uv is the sheet unfolded", "[sewing]") {
  TriangleMesh flap, folded;
  flap.positions = {{0, 0, 0}, {1, 0, 0}, {0.4, 1, 0}, {0.7, -0.8, 0}};
  flap.triangles = {{0, 1, 2}, {1, 0, 3}};
  folded = flap;
  folded.positions[3].y() = 0.8;  // on the side of the other one
  const Connections open = noh_jung_connections(flap, flap, {}),
                    mirrored = noh_jung_connections(flap, folded, {});
  REQUIRE(mirrored.bend.size() == 1);
  CHECK(mirrored.bend[0].L == Approx(open.bend[0].L));
  CHECK(mirrored.bend[0].k_b == Approx(open.bend[0].k_b));
}

TEST_CASE("a triangle that is a thousand times thinner in its texture coordinates is refused", "[sewing]") {
  const auto flat = [](const char* height) {
    return flat_pattern(
        parse_obj(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 ") +
                      height + "\nf 1/1 2/2 3/3\nf 2/1 4/2 3/4\n",
                  "needle.obj"));
  };
  CHECK(flat("0.01").triangles.size() == 2);
  for (const char* height : {"0", "1e-7", "4e-4"})
    CHECK_THROWS_WITH(flat(height), Catch::Contains("face 2 of the file has no area"));
}
