// Laws of triangles that pass through each other: as many as rational arithmetic finds, whatever is done to
// the mesh that changes none; contours close or end; and what `drape check` says of them.
#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "mesh/base/predicates.h"
#include "mesh/distance/triangle_crossings.h"
#include "mesh/obj/obj.h"
#include "mesh/obj/obj_groups.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"
#include "tests/shapes.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::internal;
using namespace drape::test;

namespace drape {
static std::ostream& operator<<(std::ostream& out, const TrianglePair& pair) {
  return out << pair.first << " " << pair.second;
}
}  // namespace drape

namespace {

using Rational = boost::multiprecision::cpp_rational;
using RationalPoint = std::array<Rational, 3>;

RationalPoint exact(const Vec3& x) { return {Rational(x[0]), Rational(x[1]), Rational(x[2])}; }

// (b - a) x (c - a) . (d - a)
Rational volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const RationalPoint o = exact(a);
  std::array<RationalPoint, 3> e = {exact(b), exact(c), exact(d)};
  for (RationalPoint& x : e)
    for (std::size_t k = 0; k < 3; ++k) x[k] -= o[k];
  const auto& [u, v, w] = e;
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
         (u[0] * v[1] - u[1] * v[0]) * w[2];
}

// Whether the edge pq passes through the triangle, by the point where it meets the plane and its three
// weights there.
bool passes(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const Rational at_p = volume(t[0], t[1], t[2], p), at_q = volume(t[0], t[1], t[2], q);
  if (at_p.sign() * at_q.sign() >= 0) return false;
  const Rational share = at_p / (at_p - at_q);
  const RationalPoint from = exact(p), to = exact(q);
  RationalPoint x;
  for (std::size_t k = 0; k < 3; ++k) x[k] = from[k] + share * (to[k] - from[k]);
  const std::array<RationalPoint, 3> c = {exact(t[0]), exact(t[1]), exact(t[2])};
  for (std::size_t drop = 0; drop < 3;
       ++drop) {  // inside of the triangle's shadow on every plane of two axes
    const std::size_t u = (drop + 1) % 3, v = (drop + 2) % 3;
    bool left = false, right = false;
    for (std::size_t e = 0; e < 3; ++e) {
      const RationalPoint &a = c[e], &b = c[(e + 1) % 3];
      const Rational turn = (b[u] - a[u]) * (x[v] - a[v]) - (b[v] - a[v]) * (x[u] - a[u]);
      left = left || turn > 0;
      right = right || turn < 0;
    }
    if (left && right) return false;
  }
  return true;
}

std::set<TrianglePair> crossing_by_rationals(const std::vector<Vec3>& x,
                                             const std::vector<Triangle>& triangles) {
  std::set<TrianglePair> pairs;
  for (int i = 0; i < static_cast<int>(triangles.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(triangles.size()); ++j) {
      const Triangle &s = triangles[i], &t = triangles[j];
      std::set<int> all(s.begin(), s.end());
      all.insert(t.begin(), t.end());
      if (all.size() < 6) continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (passes(x[s[k]], x[s[(k + 1) % 3]], {x[t[0]], x[t[1]], x[t[2]]}) ||
            passes(x[t[k]], x[t[(k + 1) % 3]], {x[s[0]], x[s[1]], x[s[2]]}))
          pairs.insert({i, j});
    }
  return pairs;
}

std::set<TrianglePair> crossing(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles) {
  std::set<TrianglePair> pairs;
  for (const CrossingContour& contour : crossing_contours(x, triangles))
    for (const TrianglePair& pair : contour.pairs) CHECK(pairs.insert(pair).second);
  return pairs;
}

// Two grids through each other, one of them turned.
TriangleMesh two_sheets(double height, double turn) {
  TriangleMesh both = grid(9, 9, 1, 1), other = grid(8, 8, 0.5, 0.5);
  const int first = both.vertex_count();
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : both.positions) middle += x / first;
  for (const Vec3& x : other.positions)
    both.positions.push_back(middle + Vec3(0.0123, height, 0.0077) +
                             rotation(turn, {1, 0.1, 0.2}) * (x - other.positions[27]));
  for (const Triangle& t : other.triangles)
    both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return both;
}

// Triangles of three vertices each, of this size [m], in a cube of 1 m.
std::pair<std::vector<Vec3>, std::vector<Triangle>> loose_triangles(int count, double size) {
  Random random;
  std::pair<std::vector<Vec3>, std::vector<Triangle>> soup;
  auto& [x, triangles] = soup;
  for (int k = 0; k < count; ++k) {
    const Vec3 middle = 0.5 * random.point(1);
    for (int corner = 0; corner < 3; ++corner) x.push_back(middle + size * random.point(1));
    triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  return soup;
}

}  // namespace

TEST_CASE("orient3d has the sign of rational arithmetic, also where doubles cannot tell", "[crossings]") {
  Random random;
  int undecided = 0;
  for (int n = 0; n < 3000; ++n) {
    const double scale = std::pow(10, random(-6, 6));
    const Vec3 a = scale * random.point(1), c = scale * random.point(1);
    Vec3 b = scale * random.point(1);
    if (n % 11 == 0) b[n % 3] = a[n % 3];
    Vec3 d = a + random(-1, 2) * (b - a) + random(-1, 2) * (c - a);  // in the plane, but for rounding
    if (n % 22 == 0) {  // nearly on the line, exactly across an axis
      d = a + random(-1, 2) * (b - a);
      d[n % 3] = a[n % 3];
    }
    if (n % 3 == 0) d[n % 2] = std::nextafter(d[n % 2], 1e9);
    if (n % 5 == 0) d = n % 2 == 0 ? a : b;
    if (n % 7 == 0) d += scale * random.point(1);
    const int expected = volume(a, b, c, d).sign();
    CHECK(orient3d(a, b, c, d) == expected);
    CHECK(orient3d(b, a, c, d) == -expected);
    CHECK(orient3d(d, c, b, a) == expected);
    undecided += std::abs(expected) != 1;
  }
  CHECK(undecided >= 100);
}

TEST_CASE("the triangles that cross are those of rational arithmetic", "[crossings]") {
  Random random;
  int found = 0;
  for (int n = 0; n < 60; ++n) {
    std::vector<Vec3> x;
    for (int v = 0; v < 24; ++v) {
      x.push_back(random.point(1));
      if (n % 2 == 1)  // on a coarse lattice: in planes, on edges, one upon the other
        for (double& c : x.back()) c = std::round(2 * c) / 2;
    }
    std::vector<Triangle> triangles;
    for (int t = 0; t < 14; ++t) triangles.push_back({random.below(24), random.below(24), random.below(24)});
    const std::set<TrianglePair> expected = crossing_by_rationals(x, triangles);
    CHECK(crossing(x, triangles) == expected);
    found += static_cast<int>(expected.size());
  }
  CHECK(found > 100);
  for (const double height : {0.0, 1e-9, 0.3}) {
    const TriangleMesh mesh = two_sheets(height, 1.2);
    const std::set<TrianglePair> expected = crossing_by_rationals(mesh.positions, mesh.triangles);
    CHECK(crossing(mesh.positions, mesh.triangles) == expected);
  }
}

TEST_CASE("crossings of many triangles are those of each two, on any number of threads", "[crossings]") {
  const ThreadsRestored restored;
  const auto [x, triangles] = loose_triangles(700, 0.5);
  const int half = static_cast<int>(triangles.size()) / 2;
  std::set<TrianglePair> expected, between;
  for (int i = 0; i < static_cast<int>(triangles.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(triangles.size()); ++j)
      if (!crossing_contours(x, {triangles[i], triangles[j]}).empty()) {
        expected.insert({i, j});
        if (i < half && j >= half) between.insert({i, j});
      }
  CHECK(between.size() > 500);
  std::vector<Passage> passages;
  for (int t : {1, 2, 7}) {
    set_threads(t);
    INFO(t << " threads");
    CHECK(crossing(x, triangles) == expected);
    CHECK(crossing_count(contours_between(x, triangles, half)) == static_cast<int>(between.size()));
    std::vector<Passage> now;
    for (const CrossingContour& contour : crossing_contours(x, triangles))
      now.insert(now.end(), contour.passages.begin(), contour.passages.end());
    if (t == 1) passages = now;
    CHECK(std::equal(now.begin(), now.end(), passages.begin(), passages.end(),
                     [](const Passage& p, const Passage& q) {
                       return std::tuple(p.a, p.b, p.of, p.through) == std::tuple(q.a, q.b, q.of, q.through);
                     }));
  }
}

TEST_CASE("the list of crossings ends at its limit", "[crossings]") {
  const auto [x, triangles] = loose_triangles(2800, 30);
  const std::vector<CrossingContour> contours = crossing_contours(x, triangles);
  CHECK(crossing_count(contours) == most_crossing_pairs);
  std::set<TrianglePair> pairs;
  for (const CrossingContour& contour : contours) {
    CHECK_FALSE(contour.passages.empty());
    pairs.insert(contour.pairs.begin(), contour.pairs.end());
  }
  CHECK(pairs.size() == static_cast<std::size_t>(most_crossing_pairs));
}

TEST_CASE("crossings do not depend on where the mesh is, how large, or how its vertices are numbered",
          "[crossings]") {
  const TriangleMesh mesh = two_sheets(0, 1.2);
  const std::set<TrianglePair> here = crossing(mesh.positions, mesh.triangles);
  REQUIRE(here.size() > 10);
  for (const double scale : {0x1p-20, 0x1p20}) {  // powers of two change no sign
    std::vector<Vec3> x = mesh.positions;
    for (Vec3& p : x) p *= scale;
    CHECK(crossing(x, mesh.triangles) == here);
  }
  std::vector<Vec3> reversed(mesh.positions.rbegin(), mesh.positions.rend());
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles) {
    for (int& v : t) v = mesh.vertex_count() - 1 - v;
    std::rotate(t.begin(), t.begin() + 1, t.end());
  }
  CHECK(crossing(reversed, triangles) == here);
  for (std::vector<Vec3>* x : {&reversed})
    for (Vec3& p : *x) p = -p;
  CHECK(crossing(reversed, triangles) == here);
}

TEST_CASE("a mesh without crossings has none, folded and sewn ones among them", "[crossings]") {
  CHECK(crossing_contours({}, {}).empty());
  const TriangleMesh sphere = lat_long_sphere(12, 24, 0.3, Vec3(1, 2, 3));
  CHECK(crossing_contours(sphere.positions, sphere.triangles).empty());
  TriangleMesh sheet = grid(21, 21, 1, 1);
  CHECK(crossing_contours(sheet.positions, sheet.triangles).empty());
  TriangleMesh twice = sheet;  // one upon the other: they touch everywhere and cross nowhere
  twice.positions.insert(twice.positions.end(), sheet.positions.begin(), sheet.positions.end());
  for (const Triangle& t : sheet.triangles) twice.triangles.push_back({t[0] + 441, t[1] + 441, t[2] + 441});
  CHECK(crossing_contours(twice.positions, twice.triangles).empty());
}

TEST_CASE("a contour is closed, or ends at a border", "[crossings]") {
  // A ball through the middle of a sheet: a circle. Through its border: an arc. Two balls: two circles.
  const auto with_balls = [](const std::vector<Vec3>& centres) {
    TriangleMesh mesh = grid(31, 31, 1, 1);
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : mesh.positions) middle += x / mesh.vertex_count();
    for (const Vec3& centre : centres) {
      const TriangleMesh ball = lat_long_sphere(9, 17, 0.1, middle + centre);
      const int first = mesh.vertex_count();
      mesh.positions.insert(mesh.positions.end(), ball.positions.begin(), ball.positions.end());
      for (const Triangle& t : ball.triangles)
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return crossing_contours(mesh.positions, mesh.triangles);
  };
  const auto circle = with_balls({{0.013, 0.007, 0.011}});
  REQUIRE(circle.size() == 1);
  CHECK(circle.front().closed);
  CHECK(crossing_count(circle) > 17);
  const auto arc = with_balls({{0.5, 0.007, 0.011}});
  REQUIRE(arc.size() == 1);
  CHECK_FALSE(arc.front().closed);
  CHECK(crossing_count(arc) < crossing_count(circle));
  const auto two = with_balls({{0.013, 0.007, 0.011}, {0.013, 0.007, 0.311}});
  REQUIRE(two.size() == 2);
  CHECK(two[0].closed);
  CHECK(two[1].closed);
  CHECK(two[0].pairs.size() >= two[1].pairs.size());
}

TEST_CASE("a triangle that is not at a finite place does not count", "[crossings]") {
  TriangleMesh mesh = two_sheets(0, 1.2);
  const std::set<TrianglePair> all = crossing(mesh.positions, mesh.triangles);
  const int gone = mesh.triangles[all.begin()->first][0];
  mesh.positions[gone].y() = std::numeric_limits<double>::infinity();
  const std::set<TrianglePair> left = crossing(mesh.positions, mesh.triangles);
  CHECK(left.size() < all.size());
  for (const TrianglePair& pair : all) {
    const auto has = [&](int t) {
      return std::find(mesh.triangles[t].begin(), mesh.triangles[t].end(), gone) != mesh.triangles[t].end();
    };
    CHECK(left.contains(pair) == (!has(pair.first) && !has(pair.second)));
  }
}

TEST_CASE("check tells the crossings of a mesh, of a scene and of a run", "[crossings]") {
  const Folder folder;
  const TriangleMesh one = grid(5, 5, 1, 1), two = two_sheets(0, 1.2);
  write_obj(folder.path / "two.obj", two, two.positions);
  write_obj(folder.path / "one.obj", one, one.positions);
  CHECK(folder.drape("check one.obj").out.find("\ncrossings: none\n") != std::string::npos);
  const int pairs = crossing_count(crossing_contours(two.positions, two.triangles));
  const std::string told = std::to_string(pairs) + " pairs of triangles cross, in ";
  const Outcome mesh = folder.drape("check two.obj");
  CHECK(mesh.exit_code == 0);
  CHECK(mesh.out.find("\ncrossings: " + told) != std::string::npos);
  CHECK(mesh.out.find("  two with itself: ") != std::string::npos);

  folder.write("scene.toml",
               "[[cloth]]\nname = \"upper\"\nmesh = \"one.obj\"\nfabric = \"cotton-poplin\"\n"
               "[[cloth]]\nname = \"lower\"\nmesh = \"one.obj\"\nfabric = \"cotton-poplin\"\n"
               "rotate = { axis = [1, 0, 0.1], angle = \"30 deg\" }\ntranslate = [0.01, 0.02, 0.03]\n");
  const Outcome scene = folder.drape("check scene.toml");
  INFO(scene.out << scene.err);
  CHECK(scene.exit_code == 0);
  CHECK(scene.out.find("  upper with lower: ") != std::string::npos);

  const Outcome run = folder.drape("drop two.obj --duration 0.08 --set cloth.0.self_contact=false --out o");
  INFO(run.out << run.err);
  CHECK(run.exit_code == 0);
  const auto crossings = nlohmann::json::parse(content(folder.path / "o/run.json"))["crossings"];
  const std::string at_start = std::to_string(crossings["start"].get<int>()),
                    at_end = std::to_string(crossings["end"].get<int>());
  CHECK(crossings["start"] >
        10);  // the flat sheets are a little bent, so that they are not those of the file
  CHECK(run.out.find(at_end + " pairs of triangles cross (" + at_start + " at the start)") !=
        std::string::npos);
  const Outcome after = folder.drape("check o");
  INFO(after.out << after.err);
  CHECK(after.exit_code == 0);
  CHECK(after.out.find("crossings at the start: " + at_start + "\n") != std::string::npos);
  CHECK(after.out.find("crossings at the end: " + at_end + " pairs") != std::string::npos);
  const std::string steps = content(folder.path / "o/steps.csv");
  CHECK(steps.substr(0, steps.find('\n'))
            .find(",crossings,tangled,pinched,body_contacts,body_overlap,torn,self_held") !=
        std::string::npos);
  CHECK(steps.substr(steps.find_last_of(',', steps.size() - 2)) == ",0\n");
  CHECK(steps.find("," + at_end + ",0,0,0,0,0,0\n") != std::string::npos);
  CHECK(crossings["max"] >= crossings["end"]);

  // What is marked is what crosses, and nothing else has changed.
  const std::size_t marked_pairs = crossing(two.positions, two.triangles).size();
  CHECK(marked_pairs > 10);
  const Outcome marking = folder.drape("check two.obj --mark marked");
  INFO(marking.out << marking.err);
  CHECK(marking.exit_code == 0);
  CHECK(marking.out.find("wrote marked/two.obj: ") != std::string::npos);
  const TriangleMesh marked = read_obj(folder.path / "marked/two.obj");
  CHECK(marked.positions == two.positions);
  CHECK(marked.triangles == two.triangles);
  std::set<int> crossed;
  for (const TrianglePair& pair : crossing(two.positions, two.triangles))
    crossed.insert({pair.first, pair.second});
  CHECK(triangles_of_group(marked, "crossing") == std::vector<int>(crossed.begin(), crossed.end()));
  for (const std::string taken : {"marked", ".", "o"}) {
    const Outcome refused = folder.drape("check two.obj --mark " + taken);
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("is there already and is no empty folder") != std::string::npos);
  }
  CHECK(folder.drape("check one.obj --mark none").out.find("nothing crosses") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path / "none"));
  CHECK(folder.drape("check scene.toml --mark cloths").exit_code == 0);
  for (const std::string name : {"upper", "lower"})
    CHECK_FALSE(triangles_of_group(read_obj(folder.path / "cloths" / (name + ".obj")), "crossing").empty());
  CHECK(folder.drape("check o --mark end").exit_code == 0);
  CHECK_FALSE(triangles_of_group(read_obj(folder.path / "end/two.obj"), "crossing").empty());

  const Outcome refused = folder.drape("simulate scene.toml --set simulation.require_clean=true --out p");
  INFO(refused.err);
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("of triangles cross at the start, such as upper with lower at (") !=
        std::string::npos);
  CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  CHECK_FALSE(std::filesystem::exists(folder.path / "p"));
}
