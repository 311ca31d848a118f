// Laws of mesh/triangles/topology.h: counts against Euler's formula, lists that do not depend on the order of
// the triangles, walks that end on any mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "mesh/base/errors.h"
#include "mesh/triangles/generate.h"
#include "mesh/triangles/topology.h"
#include "tests/tangled.h"

using namespace drape;
using namespace drape::test;

namespace drape {
static bool operator==(const Edge& s, const Edge& t) {
  return std::tie(s.a, s.b, s.triangles, s.forward) == std::tie(t.a, t.b, t.triangles, t.forward);
}
static bool operator==(const Hinge& s, const Hinge& t) {
  return std::tie(s.a, s.b, s.c, s.d) == std::tie(t.a, t.b, t.c, t.d);
}
static bool operator==(const Diagonal& s, const Diagonal& t) {
  return std::tie(s.c, s.d) == std::tie(t.c, t.d);
}
}  // namespace drape

namespace {

std::vector<TriangleMesh> all_meshes() {
  std::vector<TriangleMesh> meshes = {grid(2, 2, 1, 1), grid(7, 5, 1, 2), equilateral_sheet(6, 7, 0.1),
                                      disc(5, 1),       sphere(2, 1),     tube(7, 4, 1, 2),
                                      mesh_of(3, {}),   mesh_of(0, {}),   mesh_of(5, {{0, 1, 2}, {0, 3, 4}})};
  for (unsigned seed = 0; seed < 20; ++seed)
    meshes.push_back(tangle(9, 5 + 3 * static_cast<int>(seed), seed));
  return meshes;
}

int interior(const std::vector<Edge>& all) {
  return static_cast<int>(
      std::count_if(all.begin(), all.end(), [](const Edge& e) { return e.triangles == 2; }));
}

}  // namespace

TEST_CASE("edges and hinges are what a plain count finds", "[topology]") {
  for (const TriangleMesh& mesh : all_meshes()) {
    std::set<std::set<int>> faces;
    for (const Triangle& t : mesh.triangles) faces.insert({t[0], t[1], t[2]});
    std::erase_if(faces, [](const std::set<int>& face) { return face.size() < 3; });
    std::map<std::pair<int, int>, std::set<int>> opposite;
    for (const std::set<int>& face : faces) {
      const std::vector<int> v(face.begin(), face.end());
      opposite[{v[0], v[1]}].insert(v[2]);
      opposite[{v[1], v[2]}].insert(v[0]);
      opposite[{v[0], v[2]}].insert(v[1]);
    }
    std::set<std::tuple<int, int, int, int>> pairs;
    std::set<std::pair<int, int>> facing;
    for (const auto& [edge, vertices] : opposite) {
      for (const int c : vertices) {
        for (const int d : vertices) {
          if (c < d) pairs.emplace(c, d, edge.first, edge.second), facing.emplace(c, d);
        }
      }
    }
    const std::vector<Edge> all = edges(mesh);
    REQUIRE(all.size() == opposite.size());
    auto expected = opposite.begin();
    for (const Edge& e : all) {
      REQUIRE(std::pair(e.a, e.b) == expected->first);
      REQUIRE(e.triangles == static_cast<int>(expected->second.size()));
      REQUIRE((e.forward >= 0 && e.forward <= e.triangles));
      ++expected;
    }
    const std::vector<Hinge> bends = hinges(mesh);
    REQUIRE(bends.size() == pairs.size());
    auto pair = pairs.begin();
    for (const Hinge& h : bends) REQUIRE(std::tuple(h.c, h.d, h.a, h.b) == *pair++);
    const std::vector<Diagonal> across = diagonals(mesh);
    REQUIRE(across.size() == facing.size());
    auto face = facing.begin();
    for (const Diagonal& d : across) REQUIRE(std::pair(d.c, d.d) == *face++);
    REQUIRE(counted_triangles(mesh).size() == faces.size());
  }
}

TEST_CASE("the lists do not depend on the order or the starting corner of the triangles", "[topology]") {
  std::mt19937 random(7);
  for (const TriangleMesh& mesh : {grid(9, 8, 1, 1), sphere(2, 1), tube(5, 4, 1, 1), disc(4, 1)}) {
    TriangleMesh shuffled = mesh;
    std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
    for (Triangle& t : shuffled.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    CHECK(edges(mesh) == edges(shuffled));
    CHECK(hinges(mesh) == hinges(shuffled));
    CHECK(diagonals(mesh) == diagonals(shuffled));
    CHECK(boundary_loops(mesh) == boundary_loops(shuffled));
    CHECK(connected_pieces(mesh) == connected_pieces(shuffled));
  }
}

TEST_CASE("Euler's formula", "[topology]") {
  const auto euler = [](const TriangleMesh& mesh) {
    return mesh.vertex_count() - static_cast<int>(edges(mesh).size()) + mesh.triangle_count();
  };
  CHECK(euler(grid(8, 5, 1, 1)) == 1);
  CHECK(euler(equilateral_sheet(4, 9, 1)) == 1);
  CHECK(euler(disc(6, 1)) == 1);
  CHECK(euler(sphere(0, 1)) == 2);
  CHECK(euler(sphere(3, 1)) == 2);
  CHECK(euler(tube(9, 6, 1, 1)) == 0);
}

TEST_CASE("every interior edge of a manifold bends once", "[topology]") {
  for (const TriangleMesh& mesh : {grid(8, 5, 1, 1), equilateral_sheet(5, 6, 1), disc(4, 1), sphere(2, 1)}) {
    CHECK(static_cast<int>(hinges(mesh).size()) == interior(edges(mesh)));
  }
  // A union jack: n horizontal or vertical edges inside, one diagonal edge in each cell; around a vertex with
  // four triangles opposite vertices face each other twice, across both of its edges in line.
  const TriangleMesh sheet = grid(8, 5, 1, 1);
  CHECK(interior(edges(sheet)) == 7 * 3 + 4 * 6 + 7 * 4);
  CHECK(diagonals(mesh_of(4, {{0, 1, 2}, {1, 0, 3}})).size() == 1);
  // Four triangles around a vertex: four hinges, two diagonals.
  const TriangleMesh cross = mesh_of(5, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}});
  CHECK(hinges(cross).size() == 4);
  CHECK(diagonals(cross) == std::vector<Diagonal>{{1, 3}, {2, 4}});
}

TEST_CASE("repeated and folded triangles", "[topology]") {
  const TriangleMesh once = mesh_of(4, {{0, 1, 2}, {2, 1, 3}});
  const TriangleMesh more = mesh_of(4, {{0, 1, 2}, {2, 1, 3}, {1, 2, 0}, {3, 1, 2}, {1, 1, 3}, {2, 2, 2}});
  CHECK(edges(once) == edges(more));
  CHECK(hinges(once) == hinges(more));
  CHECK(vertex_areas(once) == vertex_areas(more));
  CHECK(boundary_loops(once) == boundary_loops(more));
  CHECK(counted_triangles(more) == std::vector<int>{0, 1});
  const TriangleMesh fan = mesh_of(5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  CHECK(hinges(fan).size() == 3);  // every pair
}

TEST_CASE("boundaries are closed walks", "[topology]") {
  CHECK(boundary_loops(grid(3, 3, 1, 1)) == std::vector<std::vector<int>>{{0, 3, 6, 7, 8, 5, 2, 1}});
  CHECK(boundary_loops(sphere(1, 1)).empty());
  CHECK(boundary_loops(tube(6, 3, 1, 1)).size() == 2);
  CHECK(boundary_loops(mesh_of(3, {{2, 1, 0}})) == std::vector<std::vector<int>>{{0, 2, 1}});
  // A bow tie: two loops that meet in a vertex.
  CHECK(boundary_loops(mesh_of(5, {{0, 1, 2}, {0, 3, 4}})) ==
        std::vector<std::vector<int>>{{0, 1, 2}, {0, 3, 4}});
  CHECK(boundary_loops(mesh_of(5, {{3, 4, 0}, {3, 1, 2}})).size() == 2);

  for (const TriangleMesh& mesh : all_meshes()) {
    std::set<std::pair<int, int>> open;
    for (const Edge& e : edges(mesh)) {
      if (e.triangles == 1) open.emplace(e.a, e.b);
    }
    const std::size_t before = open.size();
    std::size_t walked = 0;
    std::map<int, int> degree;
    for (const auto& [a, b] : open) ++degree[a], ++degree[b];
    for (const std::vector<int>& loop : boundary_loops(mesh)) {
      REQUIRE(loop.size() >= 3);
      REQUIRE(loop.front() == *std::min_element(loop.begin(), loop.end()));
      REQUIRE(std::set<int>(loop.begin(), loop.end()).size() == loop.size());
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const int v = loop[k], w = loop[(k + 1) % loop.size()];
        REQUIRE(open.erase({std::min(v, w), std::max(v, w)}) == 1);  // along boundary edges, each once
      }
      walked += loop.size();
    }
    // Where an even number of them meets everywhere, none is left over.
    const bool even =
        std::all_of(degree.begin(), degree.end(), [](const auto& d) { return d.second % 2 == 0; });
    if (even) REQUIRE(walked == before);
  }
}

TEST_CASE("vertex areas add up to the area", "[topology]") {
  for (const TriangleMesh& mesh : {grid(8, 5, 2, 3), disc(5, 1), sphere(2, 1), tube(8, 3, 1, 1)}) {
    const std::vector<double> areas = vertex_areas(mesh);
    double sum = 0;
    for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
    CHECK(std::accumulate(areas.begin(), areas.end(), 0.0) == Approx(sum).epsilon(1e-14));
  }
  const std::vector<double> areas = vertex_areas(mesh_of(4, {{0, 1, 2}}));
  CHECK(areas[3] == 0);
}

TEST_CASE("pieces are numbered by their lowest vertex", "[topology]") {
  CHECK(connected_pieces(mesh_of(8, {{7, 1, 5}, {2, 4, 6}, {6, 0, 2}})) ==
        std::vector<int>{0, 1, 0, 2, 0, 1, 0, 1});
  CHECK(connected_pieces(mesh_of(3, {{0, 0, 1}})) == std::vector<int>{0, 1, 2});
  const std::vector<int> one = connected_pieces(sphere(2, 1));
  CHECK(std::count(one.begin(), one.end(), 0) == static_cast<int>(one.size()));
}

TEST_CASE("vertices at one place are one; those without a place are none", "[topology]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> places = {{1, 0, 2}, {nan, 0, 0}, {1, -0.0, 2}, {0, 0, 0}, {nan, 0, 0}, {1, 0, 2}};
  CHECK(welded(places) == std::vector<int>{0, 1, 0, 3, 4, 0});
}
