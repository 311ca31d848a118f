// Laws of the OBJ reader: nasty input is read or refused with its line,
// polygons are cut into triangles that cover them.
#include <catch2/catch.hpp>
#include <cstdio>

#include "tests/mistakes.h"
#include "tests/obj.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;

namespace {

TriangleMesh parse(const std::string& text) { return parse_obj(text, "sheet.obj"); }

}  // namespace

TEST_CASE("bad input is refused with its line and a reason", "[obj]") {
  const std::vector<Mistake> mistakes = {
      {"", "sheet.obj:", "empty"},
      {"# nothing\n", "sheet.obj:", "no vertices"},
      {std::string("v 0 0\0 0\n", 9), "sheet.obj:", "binary"},
      {std::string("\xFF\xFEv\0 \0", 6), "sheet.obj:", "UTF-16"},
      {kTriangle, "sheet.obj:", "no faces"},
      {kTriangle + "l 1 2 3\n", "sheet.obj:", "no faces"},
      {kTriangle + "f 1 2\n", "sheet.obj:", "(sheet.obj:4: face of 2 corners"},
      {kTriangle + "f 1 2 4\n", "sheet.obj:4:", "face refers to vertex 4, but the file has 3"},
      {kTriangle + "f 1 2 4\nv 1 1\n", "sheet.obj:5:", "2 coordinates"},
      {kTriangle + "\n\nf 1 2 900\nf 1 2 3", "sheet.obj:6:", "vertex 900, but the file has 3"},
      {kTriangle + "f 1 2 99999999999999999999\n", "sheet.obj:4:", "vertex 99999999999999999999"},
      {kTriangle + "f 1 2 3000000000\n", "sheet.obj:4:", "vertex 3000000000"},
      {kTriangle + "f 1 2 0\n", "sheet.obj:4:", "count from 1"},
      {kTriangle + "f 1 2 -4\n", "sheet.obj:4:", "vertex -4"},
      {"v 0 0 0\nv 1 0 0\nf 1 2 -3\nv 0 1 0\n", "sheet.obj:3:", "before it"},
      {kTriangle + "f 1 2 x\n", "sheet.obj:4:", "'x'"},
      {kTriangle + "f 1 2 3.0\n", "sheet.obj:4:", "'3.0'"},
      {kTriangle + "f 1 2 3/x\n", "sheet.obj:4:", "'3/x'"},
      {kTriangle + "f 1 2 3/1/1/1\n", "sheet.obj:4:", "'3/1/1/1'"},
      {kTriangle + "f 1 2 /3\n", "sheet.obj:4:", "'/3'"},
      {"v 0 0 0\nv nan 0 0\n", "sheet.obj:2:", "'nan'"},
      {"v 0 0 0\nv 0 -inf 0\n", "sheet.obj:2:", "'-inf'"},
      {"v 0 0 1e999\n", "sheet.obj:1:", "'1e999'"},
      {"v 1.#IND 0 0\n", "sheet.obj:1:", "'1.#IND'"},
      {"v 1 2 3.1+e2\n", "sheet.obj:1:", "'3.1+e2'"},
      {"v 1 2 +-3\n", "sheet.obj:1:", "'+-3'"},
      {"v 1 2 0x10\n", "sheet.obj:1:", "'0x10'"},
      {"v 1 2 3,5\n", "sheet.obj:1:", "point"},
      {"v 1 2\n", "sheet.obj:1:", "2 coordinates"},
      {"v 1 2 # 3\n", "sheet.obj:1:", "2 coordinates"},
      {"v\n", "sheet.obj:1:", "0 coordinates"},
      {"v 0 0 0\nv 1 \\\n0\n", "sheet.obj:2:", "2 coordinates"},
      {"v 0 0 \\\n0\nv 1 0\n", "sheet.obj:3:", "2 coordinates"},
      {"v 0 0 0\r\nv 1 0\r\n", "sheet.obj:2:", "2 coordinates"},
      {"v 0 0 0\rv 1 0\r", "sheet.obj:2:", "2 coordinates"},
  };
  check_mistakes(mistakes, parse);
}

TEST_CASE("legal numbers are read to the last bit", "[obj]") {
  const std::vector<std::pair<std::string, double>> numbers = {{"+1", 1},
                                                               {"+2.", 2},
                                                               {".5", .5},
                                                               {"-.7e+2", -70},
                                                               {".8e-1", 0.08},
                                                               {"2.e+1", 20},
                                                               {"1e+2", 100},
                                                               {"3.1E2", 310},
                                                               {"1e-999", 0},
                                                               {"-0", 0},
                                                               {"0.1", 0.1},
                                                               {"007", 7},
                                                               {"5e-324", 5e-324},
                                                               {"1e10", 1e10},
                                                               {"9007199254740993", 9007199254740992.0},
                                                               {"0.30000000000000004", 0.1 + 0.2}};
  for (const auto& [text, value] : numbers) {
    INFO(text);
    const TriangleMesh mesh = parse_obj("v " + text + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "n.obj");
    CHECK(mesh.positions[0].x() == value);
  }
}

TEST_CASE("a triangle is a triangle in whatever way it is written", "[obj]") {
  const std::string v = kTriangle, vt = "vt 0 0\nvt 1 0\nvt 0 1\n", vn = "vn 0 0 1\n";
  const std::vector<std::string> texts = {
      v + "f 1 2 3",
      v + "f -3 -2 -1\n",
      v + vt + "f 1/1 2/2 3/3\n",
      v + vt + vn + "f 1/1/1 2/2/1 -1/-1/-1\n",
      v + vn + "f 1//1 2//1 3//1\n",
      v + "f 1// 2// 3//\n",
      v + "f 1/ 2/ 3/\n",
      v + "f 1//1 2//2 3//4\n",
      v + "f 1/9 2/8/3 3\n",
      v + "f 1/0/0 2 3\n",
      v + "f 1/99999999999999999999 2 3\n",
      v + "fo 1 2 3\n",
      v + "f +1 2 3\n",
      "f 1 2 3\n" + v,
      "v 0 0 0\nf 1 2 3\nv 1 0 0\nv 0 1 0\n",
      "\xEF\xBB\xBF" + v + "f 1 2 3\n",
      v + "f 1 2 3 # the only one",
      v + "f\t1\t2\t3\t\n",
      v + "  f 1 \\\n 2 \\\n 3",
      v + "f 1 2 3\\",
      v + "f 1 2 3 \\\n",
      v + "f 1 2\nf 1 2 3\n",
      v + "f 1 1 2\nf 1 2 3\n",
      v + "# C:\\models\\\nf 1 2 3\n",
      v + "usemtl none # \\\nf 1 2 3\n",
      "v 0 0 0 1.0\nv 1 0 0\nv 0 1 0 0.5 0.5 0.5 # red\nf 1 2 3\n",
      "v\t0  0\t 0\r\nv 1 0 0 \r\nv 0 1 0\r\nf 1 2 3\r\n",
      "v 0 0 0\r\nv 1 \\\r\n0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
      "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
      v + "vn 0 0 nan\nf 1//1 2//1 3//1\n",
      v + "vp 0.5\ncstype bspline\ncurv 0 1 1 2 3\ncurv 0 1 -1 -2\nl 1 2\nl -1 -2\nl 1 9\np 1\nf 1 2 3\nfoo "
          "bar\n",
  };
  for (const std::string& text : texts) {
    INFO(text);
    const TriangleMesh mesh = parse_obj(text, "t.obj");
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
    require_round_trip(text);
  }
}

TEST_CASE("what is passed over is named with its line", "[obj]") {
  const auto warnings = [](const std::string& text) { return parse_obj(text, "w.obj").document->warnings; };
  CHECK(warnings(kTriangle + "f 1 2 3\n").empty());
  const auto one = [&](const std::string& text) {
    const std::vector<std::string> all = warnings(text);
    INFO(text);
    REQUIRE(all.size() == 1);
    return all[0];
  };
  CHECK_THAT(one(kTriangle + "f 1 2\nf 1 2 3\n"), Contains("w.obj:4:") && Contains("2 corners"));
  CHECK_THAT(one(kTriangle + "f 1//7 2 3\n"), Contains("w.obj:4:") && Contains("normal 7"));
  CHECK_THAT(one(kTriangle + "f 1//-7 2 3\n"), Contains("w.obj:4:") && Contains("normal -7"));
  CHECK_THAT(one(kTriangle + "\nf 1/5 2/6 3/7\n"),
             Contains("w.obj:5:") && Contains("5") && Contains("2 more"));
  CHECK_THAT(one(kSquare + "f 1 2 2 3\n"), Contains("w.obj:5:") && Contains("repeat"));
  CHECK_THAT(one(kTriangle + "f 1 1 2\nf 1 2 3\n"), Contains("w.obj:4:") && Contains("twice"));
  CHECK_THAT(one(kTriangle + "f 1 2 3\nl 1 4\n"), Contains("w.obj:5:") && Contains("left out"));
  CHECK_THAT(one(kTriangle + "vn 0 x 1\nf 1//1 2 3\n"), Contains("w.obj:4:"));
}

TEST_CASE("groups and objects name the vertices of their faces", "[obj]") {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";
  const TriangleMesh mesh =
      parse_obj(v + "f 1 2 3\no left hand # of two\ng collar hem\nf 3 1 4\ng hem # again\n" +
                    "f 2 5 6\no right\nf 2 6 3\ng\nf 1 2 3\n",
                "g.obj");
  REQUIRE(mesh.groups.size() == 4);
  CHECK(group(mesh, "left hand") == std::vector<int>{0, 1, 2, 3, 4, 5});
  CHECK(group(mesh, "collar") == std::vector<int>{0, 2, 3});
  CHECK(group(mesh, "hem") == std::vector<int>{0, 1, 2, 3, 4, 5});
  CHECK(group(mesh, "right") == std::vector<int>{0, 1, 2, 5});

  const TriangleMesh reset = parse_obj(v + "o a\ng top\nf 1 2 3\no b\nf 2 5 6\n", "g.obj");
  CHECK(group(reset, "top") == std::vector<int>{0, 1, 2});
  const TriangleMesh ahead = parse_obj(v + "g top\no a\nf 1 2 3\n", "g.obj");
  CHECK(group(ahead, "top") == std::vector<int>{0, 1, 2});
}

TEST_CASE("polygons are cut into n - 2 triangles of the same area", "[obj][polygon]") {
  const auto cut = [](const std::string& v, const std::string& f) { return parse_obj(v + f, "p.obj"); };
  // An arrow head: only one diagonal lies inside.
  const std::string arrow = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\n";
  for (const char* f : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3", "f 4 3 2 1"}) {
    const TriangleMesh mesh = cut(arrow, f);
    CHECK(mesh.triangle_count() == 2);
    CHECK(area_of(mesh) == Approx(1.5));
  }
  // The shorter diagonal of a convex quad.
  CHECK(cut("v 0 0 0\nv 1 0.2 0\nv 2 0 0\nv 1 -0.2 0\n", "f 1 2 3 4\n").triangles ==
        std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}});
  // A comb, a star with a corner in the middle of an edge, coplanar with no coordinate plane.
  const std::string comb =
      "v 0 0 0\nv 5 0 5\nv 5 3 5\nv 4 3 4\nv 4 1 4\nv 3 1 3\nv 3 3 3\nv 2 3 2\nv 2 1 2\nv 1 1 1\nv 1 3 1\nv "
      "0 3 0\n";
  const TriangleMesh mesh = cut(comb, "f 1 2 3 4 5 6 7 8 9 10 11 12\n");
  CHECK(mesh.triangle_count() == 10);
  CHECK(area_of(mesh) == Approx(std::sqrt(2.0) * 11));
  CHECK(mesh.document->warnings.empty());
  // Corners in line: no triangle without area.
  const TriangleMesh line = cut("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n", "f 1 2 3 4 5\n");
  CHECK(line.triangle_count() == 3);
  for (const Triangle& t : line.triangles) CHECK(triangle_area(line, t) > 0.1);
  // Repetitions, spikes, nothing but a line, crossing itself.
  CHECK(cut(kSquare, "f 1 2 2 3 4 1\n").triangle_count() == 2);
  CHECK(cut(kSquare, "f 1 2 3 2\nf 1 2 3\n").triangle_count() == 1);
  CHECK(cut(kSquare, "f 1 2 1 2 1 2\nf 1 2 3\n").triangle_count() == 1);
  CHECK(cut("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\n", "f 1 2 3 4 5\n").triangle_count() == 3);
  const TriangleMesh crossing =
      cut("v 0 0 0\nv 2 1 0\nv 0 1 0\nv 2 0 0\nv 1 5 0\nv 1 -5 0\n", "f 1 2 3 4 5 6\n");
  CHECK(crossing.triangle_count() == 4);
}

TEST_CASE("a grid of quads becomes a union jack", "[obj][polygon]") {
  const int n = 9;
  std::string text;
  char line[80];
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      std::snprintf(line, sizeof line, "v %.4f 0 %.4f\n", i / 7.0, k / 7.0);
      text += line;
    }
  }
  for (int k = 0; k + 1 < n; ++k) {
    for (int i = 1; i < n; ++i) {
      const int p = k * n + i;
      std::snprintf(line, sizeof line, "f %d %d %d %d\n", p, p + n, p + n + 1, p + 1);
      text += line;
    }
  }
  const TriangleMesh mesh = parse_obj(text, "quads.obj");
  std::vector<int> degree(n * n, 0);
  for (const Edge& e : edges(mesh)) ++degree[e.a], ++degree[e.b];
  for (int k = 1; k + 1 < n; ++k) {
    for (int i = 1; i + 1 < n; ++i) CHECK(degree[k * n + i] == ((i + k) % 2 == 0 ? 8 : 4));
  }
}
