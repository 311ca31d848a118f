// [[rope]] in a scene: its keys, every mistake in one line, ends that are anchored and joined, what is written and drawn.
#include <cmath>

#include "app/simulation/simulation.h"
#include "mesh/lattice/solid.h"
#include "mesh/triangles/line.h"
#include "tests/export_readers.h"
#include "tests/mistakes.h"
#include "tests/png_read.h"
#include "tests/tables.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

const std::string rope = "[[rope]]\npoints = [[0, 1, 0], [1, 1, 0]]\n";  // two lines
const std::string whole = rope + "mass_per_length = \"60 g/m\"\n";       // three lines
const std::string box_text =
    "[[obstacle]]\nname = \"box\"\nshape = \"box\"\ncentre = [1, 0.9, 0]\nsize = [0.2, 0.2, 0.2]\n";

Scene read(const std::string& text, const std::filesystem::path& folder = "") {
  return read_scene(parse_toml(text, "scene.toml"), {}, folder, "scene.toml");
}

}  // namespace

TEST_CASE("a rope's keys, their units, and what stands where none is given", "[rope]") {
  const Scene scene = read(
      whole +
          "name = \"hoist\"\nsegments = 10\nstretch = \"5 kN\"\nbend = \"2e-3 N.m^2\"\ndamping = \"3 N.s\"\n"
          "bend_damping = \"1e-4 N.m^2.s\"\nradius = \"6 mm\"\npins = [{ end = \"first\" }, { vertices = [3] "
          "}]\n"
          "anchors = [{ end = \"last\", body = \"box\", at = [1, 1, 0] }]\n"
          "[[rope]]\nmesh = \"lines.obj\"\nline = \"hem\"\nspacing = \"1 cm\"\nmass_per_length = 0.1\n" +
          box_text,
      "folder");
  REQUIRE(scene.ropes.size() == 2);
  const RopeEntry& hoist = scene.ropes[0];
  CHECK(hoist.name == "hoist");
  CHECK(hoist.points.size() == 2);
  CHECK(hoist.segments == 10);
  CHECK(hoist.material.mass_per_length == Approx(0.06));
  CHECK(hoist.material.stretch == Approx(5e3));
  CHECK(hoist.material.bend == Approx(2e-3));
  CHECK(hoist.material.damping == Approx(3));
  CHECK(hoist.material.bend_damping == Approx(1e-4));
  CHECK(hoist.material.radius == Approx(6e-3));
  CHECK(std::get<PinEnd>(hoist.pins[0].rule).last == false);
  CHECK(std::get<PinVertices>(hoist.pins[1].rule).vertices == std::vector<int>{3});
  CHECK(hoist.anchors[0].last);
  CHECK(scene.ropes[1].name == "lines");
  CHECK(scene.ropes[1].mesh == std::filesystem::path("folder/lines.obj"));
  CHECK(scene.ropes[1].spacing == Approx(0.01));
}

TEST_CASE("a mistake in a rope is told with its line", "[rope]") {
  const Mistake table[] = {
      {"[[rope]]\nmass_per_length = 1\n", "scene.toml:1:", "expected either points"},
      {rope, "scene.toml:1:", "'mass_per_length' is missing"},
      {"[[rope]]\npoints = [[0, 0, 0]]\nmass_per_length = 1\n", "scene.toml:2:", "there is one"},
      {"[[rope]]\npoints = [[0, 0, 0], [1, 0, 0], [1, 0, 0]]\nmass_per_length = 1\n",
       "scene.toml:2:", "points 1 and 2 (from 0) are at one place"},
      {"[[rope]]\npoints = [[0, 0], [1, 0]]\nmass_per_length = 1\n", "scene.toml:2:", "expected"},
      {rope + "mass_per_length = 0\n", "scene.toml:3:", "greater than zero"},
      {rope + "mass_per_length = -1\n", "scene.toml:3:", "greater than zero"},
      {rope + "mass_per_length = \"3 g/m^2\"\n", "scene.toml:3:", "expected a mass per length"},
      {whole + "stretch = \"3 N/m\"\n", "scene.toml:4:", "expected a force"},
      {whole + "stretch = 0\n", "scene.toml:4:", "greater than zero"},
      {whole + "bend = \"1 N.m\"\n", "scene.toml:4:", "expected a bending stiffness of a rope"},
      {whole + "radius = 0\n", "scene.toml:4:", "greater than zero"},
      {whole + "segments = 0\n", "scene.toml:4:", "segments"},
      {whole + "segments = 4\nspacing = 0.1\n", "scene.toml:4:", "not both"},
      {whole + "bned = 1\n", "scene.toml:4:", "did you mean 'bend'?"},
      {whole + "pins = [{ end = \"middle\" }]\n", "scene.toml:4:", "first, last"},
      {whole + "pins = [{ group = \"a\" }]\n", "scene.toml:4:", "group"},
      {whole + "anchors = [{ end = \"last\", body = \"bok\" }]\n" + box_text,
       "scene.toml:4:", "did you mean 'box'?"},
      {whole + "anchors = [{ end = \"last\" }]\n", "scene.toml:4:", "'body' is missing"},
      {whole + "anchors = [{ end = \"last\", body = \"box\" }, { end = \"last\", body = \"box\" }]\n" +
           box_text,
       "scene.toml:4:", "has the same end"},
      {whole + "joins = [{ end = \"last\", to = \"rope\" }]\n",
       "scene.toml:4:", "no cloth, soft body or earlier"},
      {whole + whole, "scene.toml:4:", "two ropes are called 'rope'"},
      {"[[cloth]]\nmesh = \"a.obj\"\npins = [{ end = \"first\" }]\n",
       "scene.toml:3:", "expected one of vertices"},
  };
  check_mistakes(table, [](const std::string& text) { return read(text); });
}

TEST_CASE("an end that is not where it has to be is told by how far it is off", "[rope]") {
  const Workshop shop;
  shop.write("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\no a\nl 1 2\no b\nl 2 3\n");
  shop.write("faces.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const auto refused = [&](const std::string& text, const std::string& place, const std::string& message) {
    INFO(text);
    CHECK_THROWS_WITH(make_simulation(read(text, shop.path)), Catch::StartsWith("scene.toml:" + place) &&
                                                                  Catch::Contains(message) &&
                                                                  !Catch::Contains("\n"));
  };
  const std::string far =
      "[[obstacle]]\nname = \"box\"\nshape = \"box\"\ncentre = [1, 0.85, 0]\nsize = [0.2, 0.2, 0.2]\n";
  refused(whole + "anchors = [{ end = \"last\", body = \"box\" }]\n" + far, "4:", "50 mm outside of box");
  refused(whole + "anchors = [{ end = \"last\", body = \"box\", at = [1, 1.03, 0] }]\n" + box_text,
          "4:", "30 mm from where it is to be anchored");
  CHECK_NOTHROW(make_simulation(read(whole + "anchors = [{ end = \"last\", body = \"box\" }]\n" + box_text)));
  const std::string sheet = "[[cloth]]\nmesh = \"sheet.obj\"\n";
  refused(sheet +
              "[[rope]]\npoints = [[0, 1, 0], [0, 0.36, 0]]\nmass_per_length = 1\n"
              "joins = [{ end = \"last\", to = \"sheet\" }]\n",
          "6:", "is 10 mm from the nearest vertex of sheet (84");
  const std::string of_file = "mass_per_length = 1\n";
  refused("[[rope]]\nmesh = \"none.obj\"\n" + of_file, "1:", "no such file");
  refused("[[rope]]\nmesh = \"lines.obj\"\n" + of_file, "1:", "has 2 lines; expected the name of one: a, b");
  refused("[[rope]]\nmesh = \"lines.obj\"\nline = \"c\"\n" + of_file, "1:", "no line 'c'");
  refused("[[rope]]\nmesh = \"faces.obj\"\n" + of_file, "1:", "has no lines");
  shop.write("ring.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3 1\n");
  refused("[[rope]]\nmesh = \"ring.obj\"\n" + of_file, "1:", "a line that ends where it begins, at vertex 1");
  shop.write("beyond.obj", "v 0 0 0\nv 1 0 0\nl 1 2 9\n");
  refused("[[rope]]\nmesh = \"beyond.obj\"\n" + of_file, "1:", "beyond.obj:3: ");
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n";
  for (const char* const apart : {"l 1 2\nl 3 4\n", "l 1 2\nl 3 2\nl 2 4\n", "l 1 2\nl 3 1\nl 2 3\n"}) {
    shop.write("apart.obj", points + apart);
    refused("[[rope]]\nmesh = \"apart.obj\"\n" + of_file, "1:", "pieces that meet end to end");
  }
  shop.write("edges.obj", points + "l 3 4\nl 1 2\nl 5 4\nl 3 2\n");
  const Simulation of_edges = make_simulation(read("[[rope]]\nmesh = \"edges.obj\"\n" + of_file, shop.path));
  CHECK(of_edges.cloths[0].mesh.positions == parse_obj(points + "f 1 2 3\n", "points.obj").positions);
  const Simulation s = make_simulation(
      read("[[rope]]\nmesh = \"lines.obj\"\nline = \"b\"\nspacing = 0.3\n" + of_file, shop.path));
  CHECK(s.cloths[0].mesh.vertex_count() == 4);
  CHECK((s.cloths[0].mesh.positions[1] - Vec3(1, 1.0 / 3, 0)).norm() < 1e-15);
}

TEST_CASE("a rope is written as a line, in every format that has lines", "[rope]") {
  const Workshop shop;
  shop.write("rope.toml", "[simulation]\nduration = 0.2\n" + whole +
                              "segments = 6\npins = [{ end = \"first\" }]\nradius = 0.02\n"
                              "anchors = [{ end = \"last\", body = \"box\" }]\n" +
                              box_text + "mass = 1\n");
  const Outcome run = shop.drape("simulate rope.toml --out o");
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.out, Catch::Contains("7 particles, 1 m of rope"));
  CHECK(shop.drape("check rope.toml").exit_code == 0);
  CHECK_THAT(shop.drape("check o").out, Catch::Contains("rope of 7 points"));
  const test::Json json = shop.json("o/run.json");
  CHECK(json["cloths"].empty());
  REQUIRE(json["ropes"].size() == 1);
  CHECK(json["ropes"][0]["segments"] == 6);
  CHECK(json["ropes"][0]["length"].get<double>() == Approx(1));
  CHECK(json["ropes"][0]["material"]["radius"].get<double>() == Approx(0.02));
  CHECK(json["ropes"][0]["ends"][0]["body"] == "box");
  const TriangleMesh last = read_obj(shop.path / "o/rope.obj", ObjNeed::faces_or_lines);
  REQUIRE(polylines(last).size() == 1);
  CHECK(polylines(last)[0].name == "rope");
  CHECK(polylines(last)[0].vertices == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  const auto frames = json["frame_times"].size();
  REQUIRE(frames == 6);
  for (const char* format : {"vtk", "ply", "usda", "gltf", "csv", "obj", "mdd"})
    REQUIRE(shop.drape("export o --to " + std::string(format) + " -o " + format).exit_code == 0);
  const auto file = [&](const std::string& name) { return content(shop.path / name); };
  const ReadPolygons vtp = read_vtp(file("vtk/rope_0006.vtp")), ply = read_ply(file("ply/rope_0006.ply"));
  REQUIRE(vtp.faces.size() == 1);
  CHECK(vtp.faces[0] == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  CHECK(ply.faces.empty());
  REQUIRE(ply.edges.size() == 6);
  CHECK(ply.edges[5] == std::array<int, 2>{5, 6});
  const Places curve = read_usda(file("usda/o.usda"), "rope", "BasisCurves");
  REQUIRE(curve.size() == frames);
  CHECK_THAT(file("usda/o.usda"),
             Catch::Contains("int[] curveVertexCounts = [7]") && Catch::Contains("float[] widths = [0.04]"));
  const Places tube = read_glb(file("gltf/o.glb"), "rope");
  REQUIRE(tube.size() == frames);
  const TriangleMesh sixth = read_obj(shop.path / "obj/rope_0006.obj", ObjNeed::faces_or_lines);
  const std::size_t sides = tube.back().size() / 7;
  for (std::size_t k = 0; k < 7; ++k) {
    const Vec3& x = sixth.positions[k];
    CHECK((last.positions[k] - x).norm() < 1e-6);
    for (const Vec3& other : {vtp.places[k], ply.places[k], curve.back()[k]})
      CHECK((other - x).norm() < 1e-6);
    Vec3 middle = Vec3::Zero();
    for (std::size_t v = 0; v < sides; ++v) {
      const Vec3& of_ring = tube.back()[sides * k + v];
      CHECK((of_ring - x).norm() == Approx(0.02).epsilon(1e-4));
      middle += of_ring / static_cast<double>(sides);
    }
    CHECK((middle - x).norm() < 1e-6);
  }
}

TEST_CASE("a rope is drawn with its radius", "[rope]") {
  const Workshop shop;
  shop.write("rope.toml", "[simulation]\nduration = 0.01\ngravity = [0, 0, 0]\n" + whole +
                              "segments = 6\npins = [{ end = \"first\" }]\nradius = 0.05\n");
  REQUIRE(shop.drape("simulate rope.toml --out o --quiet").exit_code == 0);
  REQUIRE(shop.drape("view o").exit_code == 0);
  REQUIRE(shop.drape("picture o --view front --size 220x160 -o p.png").exit_code == 0);
  const Image image = read_png(content(shop.path / "p.png"));
  int left = image.width, right = -1, top = image.height, bottom = -1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!(image.at(x, y) == image.at(0, 0)))
        left = std::min(left, x), right = std::max(right, x), top = std::min(top, y),
        bottom = std::max(bottom, y);
  REQUIRE(right > left);
  CHECK(double(right - left) / (bottom - top) == Approx(10).epsilon(0.25));  // 1 m long, 10 cm thick
}

TEST_CASE("a tube is closed, and of the radius everywhere", "[rope]") {
  std::vector<Vec3> line;
  for (int k = 0; k < 30; ++k) line.emplace_back(std::cos(0.3 * k), 0.05 * k, std::sin(0.3 * k));
  const std::vector<Vec3> x = tube_positions(line, 0.01, 6);
  const TriangleMesh tube{x, tube_triangles(30, 6), {}, nullptr};
  CHECK(examine(tube).closed);
  CHECK(solid_of(tube).volume ==
        Approx(length_of(line) * 6 * 0.5 * 1e-4 * std::sin(2 * M_PI / 6)).epsilon(0.05));
  for (std::size_t k = 0; k < x.size(); ++k) CHECK((x[k] - line[k / 6]).norm() == Approx(0.01));
  const std::vector<Vec3> even = evenly_divided(line, 7);
  REQUIRE(even.size() == 8);
  CHECK(even.back() == line.back());
  CHECK(tube_positions({Vec3::Zero(), Vec3::Zero()}, 1, 3)[5].allFinite());
}
