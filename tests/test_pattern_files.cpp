// Patterns as files: units and transforms of drawings, curved sides, and everything that is refused.
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "mesh/pattern/flat_pattern.h"
#include "tests/folder.h"
#include "tests/mistakes.h"
#include "tests/obj.h"
#include "tests/patterns.h"
#include "tests/places.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

namespace {

std::string svg(const std::string& head, const std::string& body) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + head + ">\n" + body + "</svg>\n";
}

std::string many(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

const std::string kPage = "width=\"100mm\" height=\"100mm\" viewBox=\"0 0 100 100\"";

Pattern drawn(const std::string& text) {
  Names notes;
  return parse_svg_pattern(text, "p.svg", notes);
}

PatternMesh meshed(const Pattern& pattern) { return triangulate(pattern, {.edge = 0.01}); }

void check_drawing_mistakes(const std::vector<Mistake>& mistakes) {
  check_mistakes(mistakes, [](const std::string& text) { return meshed(drawn(text)); });
}

}  // namespace

TEST_CASE("the page says how long a unit of the drawing is", "[pattern]") {
  struct Page {
    std::string head;
    double side;  // m, of 50 units
  };
  for (const Page& page :
       {Page{kPage, 0.05}, Page{"width=\"10cm\" height=\"10cm\" viewBox=\"0 0 100 100\"", 0.05},
        Page{"width=\"10in\" height=\"5in\" viewBox=\"0,0,100,50\"", 0.127},
        Page{"width=\"72pt\" height=\"72pt\" viewBox=\"0 0 100 100\"", 0.0127},
        Page{"width=\"1m\" height=\"1m\" viewBox=\"-20 -20 100 100\"", 0.5}}) {
    INFO(page.head);
    const Pattern p = drawn(svg(page.head, "<rect id=\"a\" x=\"10\" y=\"20\" width=\"50\" height=\"50\"/>"));
    REQUIRE(p.panels.size() == 1);
    CHECK(std::abs(enclosed_area(p.panels[0].outline)) == Approx(page.side * page.side));
  }
  // In the pattern y points up, from the lower edge of the page.
  const Pattern p = drawn(svg(kPage, "<path id=\"a\" d=\"M10 90 h50 v-30 z\"/>"));
  CHECK((p.panels[0].outline.segments[0].start - Vec2(0.01, 0.01)).norm() < 1e-12);
  CHECK((p.panels[0].outline.segments[1].end - Vec2(0.06, 0.04)).norm() < 1e-12);
}

TEST_CASE("transforms and every path command give the same outline as plain ones", "[pattern]") {
  const std::string plain = "<path id=\"a\" d=\"M20 20 L60 20 L60 50 L20 50 Z\"/>";
  const double area = enclosed_area(drawn(svg(kPage, plain)).panels[0].outline);
  for (const std::string& same :
       {std::string("<path id=\"a\" d=\"m20 20h40v30H20V20z\"/>"),
        std::string("<g transform=\"translate(20,20)\"><g transform=\"scale(2 3)\"><rect id=\"a\" "
                    "width=\"20\" height=\"10\"/></g></g>"),
        std::string(
            "<polygon id=\"a\" transform=\"rotate(90 20 20)\" points=\"20,20 60,20 60,-10 20,-10\"/>"),
        std::string(
            "<polyline id=\"a\" transform=\"matrix(1 0 0 1 20 20)\" points=\"0 0 40 0 40 30 0 30 0 0\"/>")})
    CHECK(std::abs(enclosed_area(drawn(svg(kPage, same)).panels[0].outline)) ==
          Approx(std::abs(area)).epsilon(1e-12));
  const double pi = std::numbers::pi;
  for (const std::string& disc :
       {std::string("<circle id=\"a\" cx=\"50\" cy=\"50\" r=\"20\"/>"),
        std::string("<path id=\"a\" d=\"M70 50 A20 20 0 1 1 30 50 A20 20 0 0 1 70 50\"/>"),
        std::string("<ellipse id=\"a\" transform=\"translate(50 50) scale(2 1)\" rx=\"10\" ry=\"20\"/>")}) {
    INFO(disc);
    CHECK(std::abs(enclosed_area(drawn(svg(kPage, disc)).panels[0].outline)) ==
          Approx(4e-4 * pi).epsilon(1e-3));
  }
  const Pattern curves = drawn(svg(
      kPage, "<path id=\"a\" d=\"M10 50 Q20 30 30 50 T50 50 C60 70 70 70 80 50 S 90 40 90 10 L10 10z\"/>"));
  CHECK(curves.panels[0].outline.segments.size() == 6);
  CHECK(meshed(curves).below == 0);
}

TEST_CASE("sides, holes, lines and seams of a drawing", "[pattern]") {
  const Pattern p =
      drawn(svg(kPage + " data-seams=\"a.l=a.r\"",
                "<path id=\"a\" data-sides=\"- r top l\" d=\"M10 10 H90 V90 H10 Z M40 40 h10 v10 h-10z\"/>"
                "<path id=\"fold\" d=\"M30 10 V90\"/>"));
  REQUIRE(p.panels.size() == 1);
  CHECK(p.panels[0].holes.size() == 1);
  CHECK(p.panels[0].lines.size() == 1);
  const PatternMesh m = meshed(p);
  const std::vector<Polyline> curves = polylines(m.mesh);
  REQUIRE(curves.size() == 4);
  CHECK(curve(curves, "a.l").size() == curve(curves, "a.r").size());
  for (const int v : curve(curves, "a.fold")) CHECK(m.mesh.positions[v].x() == Approx(0.03));
  CHECK(m.panels[0].area == Approx(0.0064 - 0.0001).epsilon(1e-9));
  CHECK(curve(curves, "a.top").size() == group(m.mesh, "a.top").size());
}

TEST_CASE("the grain line of a drawing is the warp of its panel, and no line of the mesh", "[pattern]") {
  const std::string square = "<path id=\"a\" d=\"M10 10 H90 V90 H10 Z\"/>\n";
  for (const char* line :
       {"<line id=\"grain\" x1=\"40\" y1=\"80\" x2=\"60\" y2=\"40\"/>",
        "<path id=\"Grainline-3\" d=\"M40 80 L60 40\"/>", "<path class=\"thin GRAIN\" d=\"M40 80 L60 40\"/>",
        "<path id=\"front.grain\" d=\"M40 80 L60 40\"/>",
        "<path inkscape:label=\"grain\" d=\"M40 80 L60 40\"/>",
        "<path id=\"grain\" d=\"M38 76 L40 80 L44 79 M40 80 L60 40 M59 45 L60 40 L56 42\"/>",
        "<g transform=\"translate(40 80)\"><path id=\"grain\" d=\"M0 0 l 20 -40\"/></g>"}) {
    INFO(line);
    const Pattern p = drawn(svg(kPage, square + line));
    REQUIRE(p.panels.size() == 1);
    CHECK(p.panels[0].lines.empty());
    REQUIRE(p.panels[0].grain);
    CHECK((p.panels[0].grain->normalized() - Vec2(1, 2).normalized()).norm() < 1e-9);
  }
  CHECK_FALSE(drawn(svg(kPage, square)).panels[0].grain);
  CHECK(drawn(svg(kPage, "<path id=\"grain-sack\" d=\"M10 10 H90 V90 H10 Z\"/>\n")).panels[0].name ==
        "grain-sack");
}

TEST_CASE("texture coordinates are the panel, turned so that its grain runs along v", "[pattern]") {
  const std::string square = "[[panel]]\nname = \"a\"\noutline = [[0, 0], [20, 0], [24, 15], [3, 20]]\n";
  const TriangleMesh plain = triangulate(cm_pattern(square), {.edge = 0.03}).mesh;
  for (const Vec2& grain : {Vec2(1, 2), Vec2(-3, 1), Vec2(1, 0), Vec2(0, -2), Vec2(-1, -1)}) {
    INFO(grain.transpose());
    const TriangleMesh mesh = triangulate(cm_pattern(square + "grain = [" + std::to_string(grain.x()) + ", " +
                                                     std::to_string(grain.y()) + "]\n"),
                                          {.edge = 0.03})
                                  .mesh;
    CHECK(mesh.positions == plain.positions);
    CHECK(mesh.triangles == plain.triangles);
    const TriangleMesh rest = flat_pattern(mesh, 1);
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      const auto edges = [&](const TriangleMesh& of) {
        const Triangle& t = of.triangles[k];
        Eigen::Matrix2d all;
        all << (of.positions[t[1]] - of.positions[t[0]]).head<2>(),
            (of.positions[t[2]] - of.positions[t[0]]).head<2>();
        return all;
      };
      const Eigen::Matrix2d turn = edges(rest) * edges(mesh).inverse();
      CHECK((turn * turn.transpose() - Eigen::Matrix2d::Identity()).norm() < 1e-9);
      CHECK(turn.determinant() > 0);
      CHECK(std::abs((turn * grain.normalized()).x()) < 1e-9);
    }
  }
}

TEST_CASE("what a drawing does not show is no part of the pattern", "[pattern]") {
  const auto panels = [](const std::string& attributes) {
    const std::string two = "<path id=\"a\" d=\"M10 10 h20 v20z\"/><g " + attributes +
                            "><path id=\"b\" d=\"M50 50 h20 v20z\"/></g>";
    return drawn(svg(kPage, two)).panels.size();
  };
  for (const char* hidden :
       {"display=\"none\"", "style=\"display:none\"", "style=\"fill:red; display : none !important;x:y\"",
        "display=\"inline\" style=\"display:none\""})
    CHECK(panels(hidden) == 1);
  for (const char* shown : {"", "style=\"display:inline\"", "style=\"no-display:none\"",
                            "display=\"none\" style=\"display:inline\""})
    CHECK(panels(shown) == 2);
}

TEST_CASE("a segment that is a point is left out, of whatever kind", "[pattern]") {
  for (const char* point : {"C10 10 10 10 10 10", "Q10 10 10 10", "L10 10", "A5 5 0 0 1 10 10"}) {
    const Pattern p =
        drawn(svg(kPage, std::string("<path id=\"a\" d=\"M10 10 ") + point + " H90 V90 H10 Z\"/>"));
    CHECK(p.panels[0].outline.segments.size() == 4);
    CHECK(meshed(p).panels[0].area == Approx(0.0064).epsilon(1e-12));
  }
}

TEST_CASE("drawings that are refused", "[pattern]") {
  const std::string square = "<path id=\"a\" d=\"M10 10 H90 V90 H10 Z\"/>\n";
  check_drawing_mistakes({
      {"<svg", "p.svg:1: is not XML", ""},
      {"<html></html>", "p.svg:1: is not an SVG drawing", "<html>"},
      {svg("viewBox=\"0 0 10 10\"", square), "p.svg:1: the drawing has no width",
       "write the size of the page"},
      {svg("width=\"100\" height=\"100\" viewBox=\"0 0 10 10\"", square),
       "p.svg:1: width=\"100\" has no unit", "cm"},
      {svg("width=\"10kg\" height=\"10cm\" viewBox=\"0 0 10 10\"", square), "p.svg:1: width=\"10kg\"",
       "no unit of length"},
      {svg("width=\"10cm\" height=\"10cm\"", square), "p.svg:1: the drawing has no viewBox", ""},
      {svg("width=\"10cm\" height=\"10cm\" viewBox=\"0 0 100 50\"", square), "p.svg:1: a unit", "across"},
      {svg(kPage, ""), "p.svg: there is no panel", ""},
      {svg(kPage, "<path id=\"a\" d=\"M10 10 H90 V90\"/>"), "p.svg:2: path 'a': this path is open",
       "close it"},
      {svg(kPage, "<path id=\"a\" d=\"M10 10 H90 V90 L50 0 Z\"/>"),
       "p.svg:2: path 'a': crosses or touches itself", "x = 5"},
      {svg(kPage, "<path id=\"a\" d=\"M10 10 L90 10 L50 10 Z\"/>"),
       "p.svg:2: path 'a': the outline has no area", ""},
      {svg(kPage, "<path id=\"a\" d=\"M10 10 L nan 10 L50 10 Z\"/>"),
       "p.svg:2: <path>: the path cannot be read", "nan"},
      {svg(kPage, "<rect id=\"a\" x=\"10%\" y=\"1\" width=\"50\" height=\"50\"/>"),
       "p.svg:2: ", "x=\"10%\": expected a number"},
      {svg(kPage, square + square), "p.svg:3: path 'a': there is another panel 'a'", ""},
      {svg(kPage, square + "<path id=\"b\" d=\"M50 50 H140 V140 H50 Z\"/>"),
       "p.svg:2: path 'a': panel 'a' overlaps panel 'b'", ""},
      {svg(kPage, square + "<path id=\"l\" d=\"M95 5 L99 50\"/>"),
       "p.svg:3: path 'l': this path is open and in no panel", ""},
      {svg(kPage, square + "<path id=\"Grain\" d=\"M95 5 L99 50\"/>"),
       "p.svg:3: path 'Grain': this grain line is in no panel", ""},
      {svg(kPage, square + "<path id=\"grain\" d=\"M20 50 H40 H20\"/>"),
       "p.svg:3: path 'grain': a grain line goes from one end to another", ""},
      {svg(kPage,
           square + "<path id=\"grain\" d=\"M20 20 V80\"/>\n<path class=\"x grain\" d=\"M30 20 V80\"/>"),
       "p.svg:4: path: panel 'a' has another grain line", ""},
      {svg(kPage, square + "<path id=\"l\" d=\"M20 20 L95 50\"/>"),
       "p.svg:2: path 'a': crosses or touches p.svg:3: path 'l'", ""},
      {svg(kPage, "<path id=\"a\" data-sides=\"x y\" d=\"M10 10 H90 V90 H10 Z\"/>"),
       "p.svg:2: path 'a': 2 side names for 4 segments", ""},
      {svg(kPage, "<path id=\"a\" data-sides=\"x y x y\" d=\"M10 10 H90 V90 H10 Z\"/>"),
       "p.svg:2: path 'a': the name '", "follow"},
      {svg(kPage + " data-seams=\"a.x=a.z\"",
           "<path id=\"a\" data-sides=\"x - y -\" d=\"M10 10 H90 V90 H10 Z\"/>"),
       "p.svg:1: data-seams: there is no curve 'a.z'", "known are"},
      {svg(kPage + " data-seams=\"a.x-a.z\"", square), "p.svg:1: data-seams: 'a.x-a.z' is not a seam",
       "expected"},
      {svg(kPage + " data-seams=\"a.x=a.x\"",
           "<path id=\"a\" data-sides=\"x - y -\" d=\"M10 10 H90 V90 H10 Z\"/>"),
       "p.svg:1: data-seams: the seam of 'a.x'", "itself"},
      {svg(kPage, square + "<path id=\"dot\" d=\"m 50 50 h 0.05\"/>"), "p.svg:3: path 'dot': a part at x = 5",
       "shorter than half the tolerance"},
      {svg(kPage, square + "<path id=\"tick\" d=\"m 50 10 v 0.05\"/>"),
       "p.svg:3: path 'tick': a part at x = 5", "shorter than half the tolerance"},
      {svg(kPage, square + "<path id=\"b\" d=\"M10 10 H90 V90 H10 Z\"/>"),
       "p.svg:2: path 'a': panel 'a' overlaps panel 'b'", "move one"},
      {svg(kPage, many("<g>\n", 100000) + square + many("</g>", 100000)), "p.svg:1002: more than 1000 groups",
       "ungroup"},
      {svg(kPage, "<g transform=\"spin(3)\">" + square + "</g>"), "p.svg:2: the transform cannot be read",
       "spin"},
  });
}

TEST_CASE("polygons that are refused", "[pattern]") {
  const std::string panel = "[[panel]]\nname = \"a\"\n";
  check_mistakes(
      std::vector<Mistake>{
          {panel + "outline = [[0, 0], [1, 0], [1, 1]]\n", "p.toml:3:", "without a unit"},
          {"unit = \"1 kg\"\n" + panel, "p.toml:1: unit", "expected a length"},
          {panel, "p.toml:1:", "'outline' is missing"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], [5, 0], [5, 5]]\ngrain = [0, 0]\n",
           "p.toml:5:", "a direction is not [0, 0]"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], [5, 0], [5, 5]]\ngrain = 90\n",
           "p.toml:5:", "expected a direction [x, y]"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], [5, 0], [5, 5]]\ngrain = [1, \"2 cm\"]\n",
           "p.toml:5:", "expected a number"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], [1, 0, 2], [1, 1]]\n",
           "p.toml:4:", "expected a point"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], [nan, 0], [1, 1]]\n", "p.toml:4:", "finite"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], { arc = 1 }, [10, 0], [5, 5]]\n",
           "p.toml:4:", "does not reach"},
          {"unit = \"1 cm\"\n" + panel +
               "outline = [[0, 0], [5, 0], [5, 5]]\nholes = [[[8, 8], [9, 8], [9, 9]]]\n",
           "p.toml:5:", "hole is not inside"},
          {"unit = \"1 m\"\n" + panel +
               "outline = [[0, 0], [0.05, 0], [0.050000001, 0], [0.1, 0], [0.1, 0.1]]\n"
               "sides = [\"s\", \"s\", \"s\", \"-\", \"-\"]\n",
           "p.toml:2:", "two corners are too near to each other, at x = 5 cm"},
          {"unit = \"1 m\"\n" + panel +
               "outline = [[0, 0], [0.1, 0], [0.100000001, 0.000000001], [0.1, 0.1], [0, 0.1]]\n"
               "sides = [\"s\", \"s\", \"s\", \"-\", \"-\"]\n",
           "p.toml:2:", "two corners are too near"},
          {"unit = \"1 cm\"\n" + panel +
               "outline = [[0, 0], [5, 0], [5, 5]]\n[[panel.line]]\npoints = [[4, 1], [4.005, 1]]\n",
           "p.toml:", "shorter than half the tolerance"},
          {"unit = \"1 cm\"\n" + panel + "outline = [[0, 0], [5, 0], [5, 5]]\nholse = 3\n",
           "p.toml:5:", "did you mean 'holes'?"},
      },
      [](const std::string& text) { return meshed(parse_toml_pattern(text, "p.toml")); });
}

TEST_CASE("bounds that cannot be met and edges that memory cannot hold", "[pattern]") {
  const Pattern square = cm_pattern(pattern_cases()[0].text);
  CHECK_THROWS_WITH(triangulate(square, {.edge = 0.01, .min_angle = 40 * kDegree}),
                    Contains("cannot be promised"));
  CHECK_THROWS_WITH(triangulate(square, {.edge = 1e-7}), Contains("refused; use a longer edge"));
}

TEST_CASE("drape triangulate: report, files, exit codes", "[pattern]") {
  const Folder folder;
  folder.write("p.toml", "unit = \"1 cm\"\n" + pattern_cases().back().text);
  folder.write("bad.svg", "<svg/>");
  const Outcome good = folder.drape("triangulate p.toml -o cloth.obj --edge '1 cm'");
  CHECK(good.exit_code == 0);
  CHECK_THAT(good.out,
             Contains("seam a.top / b.low: ") && Contains("20 cm to 22") && Contains("gathered by"));
  CHECK(read_obj(folder.path / "cloth.obj").triangle_count() > 500);
  CHECK(folder.drape("triangulate p.toml -o cloth.obj --quiet").out.empty());
  for (const char* words :
       {"triangulate bad.svg -o x.obj", "triangulate p.toml -o x.txt", "triangulate none.svg -o x.obj",
        "triangulate p.toml -o nowhere/x.obj", "triangulate p.toml -o x.obj --edge '3 kg'",
        "triangulate p.toml -o x.obj --edge -1", "triangulate p.toml -o x.obj --min-angle 50"}) {
    INFO(words);
    const Outcome bad = folder.drape(words);
    CHECK(bad.exit_code == 2);
    CHECK(std::count(bad.err.begin(), bad.err.end(), '\n') == 1);
  }
  CHECK(folder.files() == std::set<std::string>{"p.toml", "bad.svg", "cloth.obj"});
}

TEST_CASE("the patterns of the gallery", "[pattern]") {
  for (const char* name : {"skirt", "poncho"}) {
    Names notes;
    const Pattern pattern = read_pattern(
        std::filesystem::path(source_dir()) / "data/patterns" / (std::string(name) + ".svg"), notes);
    CHECK(notes.empty());
    const PatternMesh m = triangulate(pattern, {.edge = 0.03});
    CHECK(m.below == 0);
    CHECK(m.sharp.empty());
    REQUIRE(m.seams.size() == 2);
    for (const SeamReport& seam : m.seams) CHECK(seam.length_a == Approx(seam.length_b).epsilon(1e-9));
  }
}
