// Laws of triangulated patterns: angles, edges, Delaunay, areas, curves, seams, the same bits every time.
#include <catch2/catch.hpp>
#include <cstdio>
#include <map>
#include <set>

#include "app/commands/triangulate_command.h"
#include "app/pattern/remarks.h"
#include "mesh/base/predicates.h"
#include "mesh/pattern/delaunay.h"
#include "tests/obj.h"
#include "tests/patterns.h"

using namespace drape;
using namespace drape::app;
using namespace drape::internal;
using namespace drape::test;

namespace {

Vec2 flat(const TriangleMesh& mesh, int v) { return mesh.positions[v].head<2>(); }

PatternMesh made(const PatternCase& c, double degrees = 28) {
  return triangulate(cm_pattern(c.text), {.edge = c.edge, .min_angle = degrees * kDegree});
}

double polygon_area(const TriangleMesh& mesh) {
  double twice = 0;
  for (const std::vector<int>& loop : boundary_loops(mesh))
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 a = flat(mesh, loop[i]), b = flat(mesh, loop[(i + 1) % loop.size()]);
      twice += a.x() * b.y() - a.y() * b.x();
    }
  return twice / 2;
}

}  // namespace

TEST_CASE("angles, edges, sense and area of every pattern", "[pattern]") {
  for (const PatternCase& c : pattern_cases()) {
    for (const double degrees : {20.0, 28.0, 30.0}) {
      INFO(c.name << ", " << degrees << " deg");
      const PatternMesh m = made(c, degrees);
      CHECK(m.below == 0);
      CHECK(m.smallest_angle_elsewhere >= degrees * kDegree * (1 - 1e-12));
      if (m.sharp.empty()) CHECK(m.smallest_angle >= degrees * kDegree * (1 - 1e-12));
      CHECK(m.longest_edge <= c.edge * (1 + 1e-12));
      double area = 0, longest = 0;
      for (const Triangle& t : m.mesh.triangles) {
        CHECK(orient2d(flat(m.mesh, t[0]), flat(m.mesh, t[1]), flat(m.mesh, t[2])) > 0);
        area += triangle_area(m.mesh, t);
      }
      for (const Edge& e : edges(m.mesh)) {
        CHECK(e.triangles <= 2);
        longest = std::max(longest, (flat(m.mesh, e.a) - flat(m.mesh, e.b)).norm());
      }
      CHECK(longest == Approx(m.longest_edge).epsilon(1e-12));
      CHECK(area == Approx(polygon_area(m.mesh)).epsilon(1e-12));
      CHECK(std::abs(area - c.area) <= m.tolerance * c.perimeter);
    }
  }
}

TEST_CASE("the triangulation is constrained Delaunay", "[pattern]") {
  for (const PatternCase& c : pattern_cases()) {
    INFO(c.name);
    const PatternMesh m = made(c);
    std::set<std::pair<int, int>> fixed;
    for (const Polyline& line : polylines(m.mesh))
      for (std::size_t i = 1; i < line.vertices.size(); ++i)
        fixed.insert(std::minmax(line.vertices[i - 1], line.vertices[i]));
    for (const Hinge& h : hinges(m.mesh)) {
      if (fixed.contains({h.a, h.b})) continue;
      Vec2 a = flat(m.mesh, h.a), b = flat(m.mesh, h.b), p = flat(m.mesh, h.c), q = flat(m.mesh, h.d);
      if (orient2d(a, b, p) < 0) std::swap(a, b);
      CHECK(incircle(a, b, p, q) <= 0);
    }
  }
}

TEST_CASE("curved sides are followed within the tolerance", "[pattern]") {
  for (const double tolerance : {0.0, 1e-3, 1e-5}) {
    const PatternMesh m =
        triangulate(cm_pattern(pattern_cases()[2].text), {.edge = 0.02, .tolerance = tolerance});
    for (const std::vector<int>& loop : boundary_loops(m.mesh))
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2 a = flat(m.mesh, loop[i]), b = flat(m.mesh, loop[(i + 1) % loop.size()]);
        CHECK(a.norm() == Approx(0.1).epsilon(1e-9));
        CHECK(0.1 - ((a + b) / 2).norm() <= m.tolerance);
      }
  }
}

TEST_CASE("vertices of a seam pair at equal fractions of its curves", "[pattern]") {
  for (const PatternCase& c : pattern_cases()) {
    const Pattern pattern = cm_pattern(c.text);
    if (pattern.seams.empty()) continue;
    INFO(c.name);
    const PatternMesh m = made(c);
    const std::vector<Polyline> curves = polylines(m.mesh);
    REQUIRE(m.seams.size() == pattern.seams.size());
    for (const Seam& seam : pattern.seams) {
      const std::vector<double> a = fractions(m.mesh, curve(curves, seam.a)),
                                b = fractions(m.mesh, curve(curves, seam.b));
      REQUIRE(a.size() == b.size());
      REQUIRE(a.size() > 4);
      for (std::size_t i = 0; i < a.size(); ++i)
        // The fractions are of chords, not of arcs.
        CHECK(a[i] == Approx(seam.same_way ? b[i] : 1 - b[a.size() - 1 - i]).margin(1e-3));
    }
  }
  const PatternMesh gathered = made(pattern_cases().back());
  CHECK(gathered.seams[0].length_a == Approx(0.2));
  CHECK(gathered.seams[0].length_b > 0.22);
}

TEST_CASE("an OBJ of a pattern has panels, flat coordinates and curves", "[pattern]") {
  const PatternMesh m = made(pattern_cases().back());
  const TriangleMesh read = parse_obj(format_obj(m.mesh, m.mesh.positions), "back.obj");
  require_same(m.mesh, read);
  CHECK(group(read, "a").size() + group(read, "b").size() == read.positions.size());
  REQUIRE(read.document->texcoords.size() == read.positions.size());
  for (const ObjCorner& corner : read.document->corners) {
    double x = 0, y = 0;
    REQUIRE(std::sscanf(std::string(read.document->texcoords[corner.vt]).c_str(), "%lf %lf", &x, &y) == 2);
    REQUIRE(Vec3(x, y, 0) == read.positions[corner.v]);
  }
  std::map<std::pair<int, int>, int> shared;
  for (const Edge& e : edges(read)) shared[{e.a, e.b}] = e.triangles;
  for (const Polyline& c : polylines(read))
    for (std::size_t i = 1; i < c.vertices.size(); ++i) {
      const std::pair<int, int> key = std::minmax(c.vertices[i - 1], c.vertices[i]);
      REQUIRE(shared.contains(key));
      CHECK(shared[key] == 1);  // these are all on the boundary
    }
  bool said = false;
  for (const ObjStatement& s : read.document->statements) said = said || s.text == "# seam a.top b.low";
  CHECK(said);
}

TEST_CASE("an edge is brought in only where nothing is in its way", "[pattern]") {
  Delaunay mesh({Vec2(0, 0), Vec2(4, 4)});
  const auto add = [&](double x, double y) { return mesh.add({x, y}, mesh.locate({x, y}, 0, false)); };
  const int a = add(0, 0), b = add(4, 0), middle = add(2, 0), up = add(1, 3), down = add(2.5, -3);
  CHECK_FALSE(mesh.force_edge(a, a, 0));
  CHECK_FALSE(mesh.force_edge(a, b, 0));  // the vertex in the middle
  CHECK(mesh.force_edge(a, middle, 0));
  CHECK_FALSE(mesh.force_edge(up, down, 1));  // the piece
  CHECK(mesh.find_edge(a, middle).t >= 0);
  CHECK(mesh.find_edge(up, down).t < 0);
  CHECK_THROWS_AS(mesh.edge_of(up, down), std::logic_error);
}

TEST_CASE("what is to be said of the triangles: nothing, or the corners below the bound", "[pattern]") {
  CHECK(remarks(made(pattern_cases()[0]), 28 * kDegree, "p.svg").empty());
  const PatternMesh needles = made(pattern_cases()[5]);
  const Names lines = remarks(needles, 28 * kDegree, "p.svg");
  REQUIRE(lines.size() == needles.sharp.size());
  REQUIRE(lines.size() == 5);
  for (const std::string& line : lines)
    CHECK_THAT(line, Catch::StartsWith("note: p.svg: a corner of panel star is sharper than the bound: "));
}

TEST_CASE("the same pattern gives the same bits", "[pattern]") {
  for (const PatternCase& c : pattern_cases()) {
    const PatternMesh one = made(c), two = made(c);
    CHECK(format_obj(one.mesh, one.mesh.positions) == format_obj(two.mesh, two.mesh.positions));
  }
}

TEST_CASE("predicates are exact where rounding decides", "[pattern]") {
  const Vec2 a(0.5, 0.5), b(12, 12);
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j) {
      const Vec2 c(24 + i * 0x1p-48, 24 + j * 0x1p-48);  // sums of these are exact to more digits only
      CHECK(orient2d(a, b, c) == (j > i) - (j < i));
    }
  const Vec2 p(1, 0), q(0, 1), r(-1, 0);
  CHECK(incircle(p, q, r, {0, -1}) == 0);
  CHECK(incircle(p, q, r, {0x1p-60, -1}) < 0);
  CHECK(incircle(p, q, r, {0, -1 + 0x1p-53}) > 0);
  CHECK(incircle(p, q, r, {0, -1 - 0x1p-52}) < 0);
}
