// Where the warp runs: one direction, an angle from the grain, or one of these for each group of the mesh.
#include <catch2/catch.hpp>
#include <cmath>

#include "app/scene/scene.h"
#include "app/simulation/simulation.h"
#include "mesh/obj/obj.h"
#include "mesh/obj/obj_groups.h"
#include "mesh/obj/obj_mark.h"
#include "solver/assembly/assembly.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;

namespace {

// Two squares of 1 m side by side, which share the corners 2 and 3, and an ear whose corners are all in both
// groups.
const std::string two_squares =
    "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\nv 1 2 0\n"
    "vt 0 0\nvt 0 1\nvt 1 0\nvt 1 1\nvt 2 0\nvt 2 1\nvt 1 2\n"
    "g left  # a comment\nf 1/1 3/3 4/4 2/2\nf 2/2 4/4 7/7\ng right\nf 3/3 5/5 6/6 4/4\nf 4/4 6/6 7/7\n";

Fabric directed() {
  Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-5};
  fabric.weave = {.stretch_weft = 100, .shear = 40, .poisson = 0.2};
  return fabric;
}

ClothPart part_of(const TriangleMesh& mesh) {
  return {.mesh = mesh, .fabric = directed(), .model = ClothModel::woven, .imperfection = 0.0};
}

// The energy of the sheet where x and y are stretched by these strains.
double energy(ClothPart part, double along_x, double along_y) {
  Assembly sheet(Vec3::Zero());
  sheet.add(std::move(part));
  sheet.use("implicit-euler", "mpcg", {});
  for (int i = 0; i < sheet.state.particles(); ++i) {
    sheet.state.x[3 * i] *= 1 + along_x;
    sheet.state.x[3 * i + 1] *= 1 + along_y;
  }
  return sheet.system->elastic_energy(sheet.state.x);
}

const std::string scene_of_squares =
    "[[cloth]]\nmesh = \"squares.obj\"\nmodel = \"woven\"\n"
    "stretch = { warp = 500, weft = 100, shear = 40 }\nimperfection = 0\n";

}  // namespace

TEST_CASE("the triangles of a group are those of its faces", "[obj][warp]") {
  const TriangleMesh mesh = parse_obj(two_squares, "squares.obj");
  using drape::internal::faces_of_triangles;
  using drape::internal::triangles_of_group;
  CHECK(faces_of_triangles(mesh) == std::vector<std::size_t>{0, 0, 1, 2, 2, 3});
  CHECK(triangles_of_group(mesh, "left") == std::vector<int>{0, 1, 2});
  CHECK(triangles_of_group(mesh, "right") == std::vector<int>{3, 4, 5});
  CHECK(triangles_of_group(mesh, "none").empty());
  TriangleMesh plain = mesh;
  plain.document.reset();
  CHECK(triangles_of_group(plain, "left") == std::vector<int>{0, 1, 2});

  const TriangleMesh nested =
      parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\no whole\ng a b\nf 1 2 3\ng b\nf 2 4 3\n", "n.obj");
  CHECK(triangles_of_group(nested, "whole") == std::vector<int>{0, 1});
  CHECK(triangles_of_group(nested, "a") == std::vector<int>{0});
  CHECK(triangles_of_group(nested, "b") == std::vector<int>{0, 1});
}

TEST_CASE("faces that are put into a group stand there alone, and all else in the file stays", "[obj]") {
  using drape::internal::faces_of_triangles;
  using drape::internal::triangles_of_group;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\n";
  const std::vector<std::string> texts = {
      two_squares, vertices + "f 1 2 4 3\nf 2 5 4\nf 5 6 4\n",
      vertices + "o whole\ng a b\nf 1 2 4 3\nl 1 5\ng b\nusemtl red\nf 2 5 4\nf 5 6 4\nl 1 6\n",
      vertices + "o hem\nf 1 2 3\nl 1 2\nf 2 4 3\ng off\nf 2 5 4\nl 2 5\n",
      vertices + "g a\nf 1 2 3\no one\nf 2 4 3\ng c\no two\n# between\nf 2 5 4\no three\nf 5 6 4\n"};
  for (const std::string& text : texts) {
    const TriangleMesh mesh = parse_obj(text, "m.obj");
    const std::vector<std::size_t> faces = faces_of_triangles(mesh);
    for (unsigned chosen = 0; chosen < 1U << mesh.document->face_count(); ++chosen) {
      std::vector<int> in, out;  // triangles
      for (int t = 0; t < mesh.triangle_count(); ++t) (chosen >> faces[t] & 1 ? in : out).push_back(t);
      TriangleMesh marked = mesh;
      marked.document = std::make_shared<ObjDocument>(with_group(mesh, in, "crossing"));
      const TriangleMesh read = parse_obj(format_obj(marked, mesh.positions), "read.obj");
      INFO(format_obj(marked, mesh.positions));
      CHECK(read.triangles == mesh.triangles);
      CHECK(read.document->corners == mesh.document->corners);
      CHECK(triangles_of_group(read, "crossing") == in);
      for (const VertexGroup& group : mesh.groups) {
        const bool object = text.find("o " + group.name + "\n") != std::string::npos;
        const std::vector<int> had = triangles_of_group(mesh, group.name);
        std::vector<int> left;
        std::set_difference(had.begin(), had.end(), in.begin(), in.end(), std::back_inserter(left));
        CHECK(triangles_of_group(read, group.name) == (object ? had : left));
      }
      // Nothing else is a group now, and lines keep their names.
      for (const VertexGroup& group : read.groups)
        CHECK((group.name == "crossing" ||
               std::any_of(mesh.groups.begin(), mesh.groups.end(),
                           [&](const VertexGroup& had) { return had.name == group.name; })));
      const std::vector<Polyline> lines = polylines(read), had_lines = polylines(mesh);
      REQUIRE(lines.size() == had_lines.size());
      for (std::size_t k = 0; k < lines.size(); ++k) {
        CHECK(lines[k].name == had_lines[k].name);
        CHECK(lines[k].vertices == had_lines[k].vertices);
      }
      TriangleMesh again = read;  // what was marked before is not, unless it is again
      again.document = std::make_shared<ObjDocument>(with_group(read, out, "crossing"));
      CHECK(triangles_of_group(parse_obj(format_obj(again, mesh.positions), "again.obj"), "crossing") == out);
      std::size_t next = 0;  // what stood in the file stands there still, in the same order
      for (const ObjStatement& statement : read.document->statements)
        if (next < mesh.document->statements.size() && statement == mesh.document->statements[next]) ++next;
      CHECK(next == mesh.document->statements.size());
    }
    TriangleMesh plain = mesh;
    plain.document.reset();
    const std::vector<int> one = {1};
    plain.document = std::make_shared<ObjDocument>(with_group(plain, one, "crossing"));
    const TriangleMesh read = parse_obj(format_obj(plain, plain.positions), "plain.obj");
    CHECK(read.triangles == mesh.triangles);
    CHECK(triangles_of_group(read, "crossing") == one);
  }
}

TEST_CASE("each group is as stiff as its own warp says", "[woven][warp]") {
  const TriangleMesh mesh = parse_obj(two_squares, "squares.obj");
  ClothPart along_x = part_of(mesh), along_y = part_of(mesh), both = part_of(mesh);
  along_x.warp = Vec3::UnitX();
  along_y.warp = Vec3::UnitY();
  both.group_warps = {{"left", Vec3::UnitX()}, {"right", Vec3(0, -2, 0)}};  // sign and length do not matter
  const double x = energy(along_x, 0.01, 0), y = energy(along_y, 0.01, 0);
  CHECK(x == Approx(5 * y).epsilon(1e-9));  // 500 and 100 N/m: the same areas, and the same Poisson's ratio
  CHECK(energy(both, 0.01, 0) == Approx(0.5 * (x + y)).epsilon(1e-9));

  both.group_warps.pop_back();
  CHECK_THROWS_WITH(energy(both, 0, 0), Contains("in triangle 4 is not known"));
  both.warp = Vec3::UnitY();  // of the triangles whose group is not named
  CHECK(energy(both, 0.01, 0) == Approx(0.5 * (x + y)).epsilon(1e-9));
}

TEST_CASE("a scene gives the warp by vector, by angle and by group", "[scene][warp]") {
  const Folder folder;
  folder.write("squares.obj", two_squares);
  const auto energy_with = [&](const std::string& words) {
    folder.write("scene.toml", scene_of_squares + words);
    app::Simulation sheet = app::make_simulation(app::read_scene(folder.path / "scene.toml", {}));
    for (int i = 0; i < sheet.state.particles(); ++i) sheet.state.x[3 * i] *= 1.01;
    return sheet.system->elastic_energy(sheet.state.x);
  };
  const double weft = energy_with("warp = [0, 1, 0]\n"), warp = energy_with("warp = [1, 0, 0]\n");
  CHECK(warp == Approx(5 * weft).epsilon(1e-9));
  const std::string uv = "rest = \"uv\"\n";
  CHECK(energy_with(uv) == Approx(weft).epsilon(1e-9));
  CHECK(energy_with(uv + "warp = \"90 deg\"\n") == Approx(warp).epsilon(1e-9));
  CHECK(energy_with(uv + "warp = \"30 deg\"\n") ==
        Approx(energy_with(uv + "warp = [-0.5, 0.8660254037844386, 0]\n")).epsilon(1e-9));
  CHECK(energy_with(uv + "warp = { right = \"90 deg\" }\n") == Approx(0.5 * (warp + weft)).epsilon(1e-9));
  CHECK(energy_with("warp = { right = [1, 0, 0], left = [0, 1, 0] }\n") ==
        Approx(0.5 * (warp + weft)).epsilon(1e-9));

  struct Mistake {
    const char *words, *said;
  };
  const Mistake table[] = {
      {"warp = { right = [1, 0, 0] }\n", "in triangle 1 is not known; give its direction"},
      {"warp = { rigt = [1, 0, 0], left = [0, 1, 0] }\n", "no faces in a group 'rigt'; did you mean 'right'"},
      {"warp = {}\n", "names no group"},
      {"warp = { left = [0, 0, 0] }\n", "a direction is not [0, 0, 0]"},
      {"warp = { left = [0, 1] }\n", "left = [0, 1]"},
      {"warp = { left = { x = 1 } }\n", "expected a direction [x, y, z], or an angle"},
      {"warp = true\n", "expected \"down\", a direction [x, y, z], or an angle"},
      {"warp = \"30 deg\"\n", "goes with rest = \"uv\""},
      {"warp = \"30 cm\"\nrest = \"uv\"\n", "expected an angle"},
      {"warp = { left = [0, 0, 1], right = [0, 1, 0] }\n", "square to the warp"}};
  for (const Mistake& mistake : table) {
    folder.write("scene.toml", scene_of_squares + mistake.words);
    const Outcome run = folder.drape("check scene.toml");
    INFO(mistake.words << run.err);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Contains("scene.toml:") && Contains(mistake.said));
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
  }
  std::string needle =
      two_squares;  // the ear of the left square has its three vt in a line, but for rounding
  needle.replace(needle.find("vt 1 2\n"), 7, "vt 2 1.0000000001\n");
  folder.write("squares.obj", needle);
  folder.write("scene.toml", scene_of_squares + uv);
  CHECK_THAT(folder.drape("check scene.toml").err, Contains("face 2 of the file has no area in its texture"));
  folder.write("squares.obj", "o whole\n" + two_squares);
  folder.write("scene.toml", scene_of_squares + "warp = { whole = [0, 1, 0], left = [1, 0, 0] }\n");
  CHECK_THAT(folder.drape("check scene.toml").err, Contains("is in the groups 'left' and 'whole'"));
}

TEST_CASE("a run keeps the warp of each group", "[scene][warp]") {
  const Folder folder;
  folder.write("squares.obj", two_squares);
  folder.write("scene.toml", "[simulation]\nduration = 0.01\n" + scene_of_squares +
                                 "rest = \"uv\"\nwarp = { left = \"90 deg\" }\n");
  const Outcome run = folder.drape("simulate scene.toml --out out --quiet");
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(content(folder.path / "out/run.json"), Contains("group_warps") && Contains("\"left\""));
}
