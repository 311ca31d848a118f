// Laws of the OBJ reader and writer: nothing is lost in a round trip, nasty input is read or refused with its
// line, and tinyobjloader, where it reads a file properly, reads the same.
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mesh/examine.h"
#include "mesh/generate.h"
#include "mesh/obj.h"
#include "mesh/polygon.h"
#include "mesh/topology.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
#pragma GCC diagnostic pop

using namespace drape;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string refusal(const std::string& text) {
  try {
    parse_obj(text, "sheet.obj");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<fs::path> shared_meshes(const std::string& folder) {
  std::vector<fs::path> files;
  const fs::path root = fs::path(DRAPE_SHARED_DIR) / "meshes";
  std::error_code missing;
  if (!fs::is_directory(root / folder, missing)) {
    WARN("no shared meshes: skipped");
    return files;
  }
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (entry.path().extension() == ".obj") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Meshes of the shared folder that our reader should accept.
std::vector<fs::path> good_meshes() {
  static const std::vector<std::string> bad = {
      "line-prim", "issue-140-zero-face-idx", "invalid-face-definition",
      "test-nan",  "number_formats",          "malformed"};
  std::vector<fs::path> files = shared_meshes("");
  std::erase_if(files,
                [](const fs::path& f) { return std::find(bad.begin(), bad.end(), f.stem()) != bad.end(); });
  return files;
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void require_same(const TriangleMesh& one, const TriangleMesh& two) {
  REQUIRE(one.positions == two.positions);
  REQUIRE(one.triangles == two.triangles);
  REQUIRE(one.groups.size() == two.groups.size());
  for (std::size_t g = 0; g < one.groups.size(); ++g) {
    REQUIRE(one.groups[g].name == two.groups[g].name);
    REQUIRE(one.groups[g].vertices == two.groups[g].vertices);
  }
  const ObjDocument &a = *one.document, &b = *two.document;
  REQUIRE(a.vertex_extras == b.vertex_extras);
  REQUIRE(a.texcoords == b.texcoords);
  REQUIRE(a.face_start == b.face_start);
  REQUIRE(a.statements == b.statements);
  REQUIRE(a.corners.size() == b.corners.size());
  for (std::size_t k = 0; k < a.corners.size(); ++k) {
    REQUIRE(a.corners[k].v == b.corners[k].v);
    REQUIRE(a.corners[k].vt == b.corners[k].vt);
    REQUIRE((a.corners[k].vn < 0) == (b.corners[k].vn < 0));
  }
}

void require_round_trip(const std::string& text) {
  const TriangleMesh first = parse_obj(text, "first.obj");
  const std::string written = format_obj(first, first.positions);
  const TriangleMesh second = parse_obj(written, "second.obj");
  require_same(first, second);
  REQUIRE(second.document->warnings.size() <= first.document->warnings.size());
  REQUIRE(format_obj(second, second.positions) == written);
}

struct Oracle {
  tinyobj::attrib_t attrib;
  std::vector<tinyobj::index_t> corners;
  std::vector<int> face_sizes;
  bool good = false;
};

Oracle tiny(const std::string& text) {
  Oracle oracle;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  std::istringstream stream(text);
  oracle.good =
      tinyobj::LoadObj(&oracle.attrib, &shapes, &materials, &warning, &error, &stream, nullptr, false);
  for (const tinyobj::shape_t& shape : shapes) {
    oracle.corners.insert(oracle.corners.end(), shape.mesh.indices.begin(), shape.mesh.indices.end());
    for (const auto n : shape.mesh.num_face_vertices) oracle.face_sizes.push_back(static_cast<int>(n));
  }
  return oracle;
}

void require_like_tiny(const std::string& text) {
  const TriangleMesh mesh = parse_obj(text, "mesh.obj");
  const Oracle oracle = tiny(text);
  REQUIRE(oracle.good);
  REQUIRE(oracle.attrib.vertices.size() == 3 * mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) {  // its own number parser is some last bits off
      const double theirs = oracle.attrib.vertices[3 * i + k];
      REQUIRE(mesh.positions[i][k] == Approx(theirs).epsilon(1e-12).margin(1e-15));
    }
  }
  const ObjDocument& document = *mesh.document;
  REQUIRE(oracle.face_sizes.size() == document.face_count());
  REQUIRE(oracle.corners.size() == document.corners.size());
  const bool normals = !document.normals.empty(), texcoords = document.texcoords.size() > 0;
  for (std::size_t k = 0; k < oracle.corners.size(); ++k) {
    REQUIRE(oracle.corners[k].vertex_index == document.corners[k].v);
    if (texcoords) REQUIRE(oracle.corners[k].texcoord_index == document.corners[k].vt);
    if (normals) REQUIRE(oracle.corners[k].normal_index == document.corners[k].vn);
  }
  for (std::size_t f = 0; f < document.face_count(); ++f) {
    REQUIRE(oracle.face_sizes[f] == static_cast<int>(document.face_start[f + 1] - document.face_start[f]));
  }
}

std::vector<int> group(const TriangleMesh& mesh, const std::string& name) {
  for (const VertexGroup& g : mesh.groups) {
    if (g.name == name) return g.vertices;
  }
  return {};
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
  return sum;
}

}  // namespace

TEST_CASE("bad input is refused with its line and a reason", "[obj]") {
  struct Case {
    std::string text, place, reason;
  };
  const std::vector<Case> cases = {
      {"", "sheet.obj:", "empty"},
      {"# nothing\n", "sheet.obj:", "no vertices"},
      {std::string("v 0 0\0 0\n", 9), "sheet.obj:", "binary"},
      {std::string("\xFF\xFEv\0 \0", 6), "sheet.obj:", "UTF-16"},
      {kTriangle, "sheet.obj:", "no faces"},
      {kTriangle + "l 1 2 3\n", "sheet.obj:", "no faces"},
      {kTriangle + "f 1 2\n", "sheet.obj:4:", "2 corners"},
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
  for (const Case& c : cases) {
    INFO(c.text);
    const std::string message = refusal(c.text);
    CHECK_THAT(message, Contains(c.place));
    CHECK_THAT(message, Contains(c.reason));
    CHECK(message.find('\n') == message.npos);
  }
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

TEST_CASE("statements stay between the faces they stood between", "[obj]") {
  const std::string text =
      "# head\nmtllib a.mtl\no sheet\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nvt 0 0\nvt "
      "1 0 0.5\n"
      "usemtl red\ns 1\nf 1/1 2/2 3/1\n# between\nusemtl blue\nf 1 3 4\nl 1/1 2/2\np 3\n# tail\n";
  const TriangleMesh mesh = parse_obj(text, "s.obj");
  CHECK(format_obj(mesh, mesh.positions) == text);

  const TriangleMesh comment = parse_obj(kTriangle + "f 1 2 3 # hello\n", "s.obj");
  CHECK_THAT(format_obj(comment, comment.positions), Contains("# hello\nf 1 2 3\n"));
}

TEST_CASE("positions survive writing to the last bit", "[obj]") {
  TriangleMesh mesh = grid(3, 3, 1.0 / 3, 0.1);
  mesh.positions[4] = {1e-300, -123456789.123456789, 4.9e-324};
  require_same(parse_obj(format_obj(mesh, mesh.positions), "a"),
               parse_obj(format_obj(mesh, mesh.positions), "b"));
  const TriangleMesh again = parse_obj(format_obj(mesh, mesh.positions), "again.obj");
  CHECK(again.positions == mesh.positions);
  CHECK(again.triangles == mesh.triangles);
  CHECK_THROWS_AS(format_obj(mesh, {}), InputError);
  mesh.positions[0].x() = NAN;
  CHECK_THROWS_AS(format_obj(mesh, mesh.positions), InputError);
}

TEST_CASE("normals are computed anew and keep hard and soft edges", "[obj]") {
  // Two quads over the edge 2 3, folded by 90 degrees after reading.
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\nv 2 0 1\n";
  std::vector<Vec3> folded = parse_obj(v + "f 1 2 3\n", "v").positions;
  folded[4] = {1, 1, 0}, folded[5] = {1, 1, 1};
  const auto corner_normals = [&](const std::string& text) {
    const TriangleMesh written = parse_obj(format_obj(parse_obj(v + text, "n.obj"), folded), "w.obj");
    std::vector<Vec3> normals;
    for (const ObjCorner& c : written.document->corners)
      normals.push_back(written.document->normals.at(c.vn));
    return normals;
  };
  const Vec3 floor(0, 1, 0), wall(-1, 0, 0), soft = (floor + wall).normalized();
  const auto same = [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-6; };

  // One vn for all, as exporters write for a flat sheet: smooth at the shared vertices, true elsewhere.
  const std::vector<Vec3> smooth = corner_normals("vn 0 1 0\nf 1//1 4//1 3//1 2//1\nf 2//1 3//1 6//1 5//1\n");
  CHECK(same(smooth[0], floor));
  CHECK(same(smooth[2], soft));
  CHECK(same(smooth[5], soft));
  CHECK(same(smooth[7], wall));
  // One vn for each face: a hard edge.
  const std::vector<Vec3> hard =
      corner_normals("vn 0 1 0\nvn 0 1 0\nf 1//1 4//1 3//1 2//1\nf 2//2 3//2 6//2 5//2\n");
  for (int k = 0; k < 4; ++k) CHECK((same(hard[k], floor) && same(hard[4 + k], wall)));
  // Normals that pointed against the winding still do.
  CHECK(same(corner_normals("vn 0 -1 0\nf 1//1 4//1 3//1 2//1\nf 2//1 3//1 6//1 5//1\n")[0], -floor));
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

TEST_CASE("files that cannot be read or written say so in one line", "[obj]") {
  const fs::path folder = fs::temp_directory_path() / "drape_test_obj";
  fs::remove_all(folder);
  fs::create_directories(folder);
  CHECK_THROWS_WITH(read_obj(folder / "none.obj"), Contains("none.obj") && Contains("no such file"));
  CHECK_THROWS_WITH(read_obj(folder), Contains("is a directory"));
  std::ofstream(folder / "empty.obj").close();
  CHECK_THROWS_WITH(read_obj(folder / "empty.obj"), Contains("empty"));

  const TriangleMesh mesh = grid(5, 4, 1, 1);
  write_obj(folder / "grid.obj", mesh, mesh.positions);
  write_obj(folder / "grid.obj", mesh, mesh.positions);  // over an older one
  const TriangleMesh again = read_obj(folder / "grid.obj");
  CHECK(again.positions == mesh.positions);
  CHECK(again.triangles == mesh.triangles);
  CHECK_THROWS_AS(write_obj(folder / "no_folder" / "grid.obj", mesh, mesh.positions), InputError);
  CHECK_THROWS_WITH(write_obj(folder, mesh, mesh.positions), Contains("is a directory"));
  if (fs::exists("/dev/full"))
    CHECK_THROWS_WITH(write_obj("/dev/full", mesh, mesh.positions), Contains("space"));
  CHECK_THROWS_AS(write_obj(folder / "grid.obj", mesh, {}), InputError);
  CHECK(read_obj(folder / "grid.obj").positions == mesh.positions);  // the older one is still there
  CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) ==
        2);  // no temporary files left
  fs::remove_all(folder);
}

TEST_CASE("tinyobjloader reads the same from our strings", "[obj][oracle]") {
  const std::string vt = "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n", vn = "vn 0 0 1\nvn 0 1 0\n";
  for (const std::string& text :
       std::vector<std::string>{kSquare + "f 1 2 3 4\n", kSquare + "f -4 -3 -2\nf 1 3 4\n",
                                kSquare + vt + vn + "f 1/1/1 2/2/1 3/3/2 4/4/2\n",
                                kSquare + vn + "g a b\nf 1//1 2//2 3//1\no c\nf -4//-1 -2//-2 -1//-1\n",
                                kSquare + "s 1\nusemtl x\nf 1 2 3\nf 1 3 4",
                                "v 0 0 0 1 0 0\r\nv +1. .5 1e-3 0 1 0\r\nv 0 1 0 0 0 1\r\nf 1 2 3\r\n"}) {
    INFO(text);
    require_like_tiny(text);
  }
}

TEST_CASE("tinyobjloader reads the same from real files", "[obj][oracle][shared]") {
  // Where it does not: line continuation, and 'f' of references it resolves although nothing is there.
  const std::vector<std::string> different = {"wallhole", "face_in_group_name_mid_file",
                                              "smoothing-group-two-squares", "polygonfaces",
                                              "issue-161-inconsistent-f"};
  int compared = 0;
  for (const fs::path& file : good_meshes()) {
    if (std::find(different.begin(), different.end(), file.stem()) != different.end()) continue;
    INFO(file.filename().string());
    require_like_tiny(read_text(file));
    ++compared;
  }
  CHECK((compared == 0 || compared > 40));
}

TEST_CASE("real files survive a round trip", "[obj][shared]") {
  for (const fs::path& file : good_meshes()) {
    INFO(file.filename().string());
    require_round_trip(read_text(file));
    const TriangleMesh mesh = read_obj(file);
    const ObjDocument& document = *mesh.document;
    if (document.warnings.empty())
      CHECK(mesh.triangles.size() == document.corners.size() - 2 * document.face_count());
    for (const Triangle& t : mesh.triangles) CHECK((t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
  }
}

TEST_CASE("files with quirks do what their manifest says", "[obj][shared]") {
  const fs::path folder = fs::path(DRAPE_SHARED_DIR) / "meshes" / "quirks";
  if (shared_meshes("quirks").empty()) return;
  struct Refused {
    std::string name, message;
  };
  const std::vector<Refused> refused = {
      {"line-prim", "no faces"},   {"issue-140-zero-face-idx", ":16: face refers to vertex 0"},
      {"test-nan", ":12: "},       {"invalid-face-definition", ":15: face of 1 corner"},
      {"number_formats", ":11: "}, {"malformed", ":28: face refers to vertex 0"}};
  for (const Refused& r : refused) {
    CHECK_THROWS_WITH(read_obj(folder / (r.name + ".obj")), Contains(r.name + ".obj") && Contains(r.message));
  }
  struct Loaded {
    std::string name;
    int vertices, faces, triangles;
  };
  const std::vector<Loaded> loaded = {{"negative_indices", 8, 6, 12},
                                      {"wallhole", 92, 13, 66},
                                      {"polygonfaces", 5, 1, 3},
                                      {"face_in_group_name_mid_file", 5, 2, 2},
                                      {"two_objects", 12, 16, 16},
                                      {"joined_tetrahedra", 5, 8, 8},
                                      {"cornell_box", 76, 18, 36},
                                      {"concave_polygon", 64, 1, 64},
                                      {"smoothing-group-two-squares", 6, 2, 3},
                                      {"platonic_shelf", 50, 50, 80},
                                      {"dodecahedron_poly", 20, 12, 36},
                                      {"fan3", 5, 3, 3}};
  for (const Loaded& l : loaded) {
    INFO(l.name);
    const TriangleMesh mesh = read_obj(folder / (l.name + ".obj"));
    CHECK(mesh.vertex_count() == l.vertices);
    CHECK(static_cast<int>(mesh.document->face_count()) == l.faces);
    CHECK(mesh.triangle_count() == l.triangles);
  }
  // The ring that touches itself: its triangles cover it exactly once.
  const TriangleMesh ring = read_obj(folder / "concave_polygon.obj");
  std::vector<int> corners;
  for (const ObjCorner& c : ring.document->corners) corners.push_back(c.v);
  CHECK(area_of(ring) == Approx(newell_normal(ring.positions, corners.data(), 66).norm()).epsilon(1e-9));
  CHECK(boundary_loops(ring).size() == 2);
  CHECK(group(read_obj(folder / "two_objects.obj"), "tetra") == std::vector<int>{8, 9, 10, 11});
  CHECK(group(read_obj(folder / "face_in_group_name_mid_file.obj"), "Three") == std::vector<int>{0, 2, 4});
}
