// Laws of examine(): every defect that is put into a mesh is found at its place, a good mesh has none, real
// files are counted as their manifest counts them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "mesh/obj/examine.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/places.h"

using namespace drape;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

// The one defect of this mesh.
Defect only_defect(const TriangleMesh& mesh) {
  const MeshReport report = examine(mesh);
  for (const Defect& d : report.defects) UNSCOPED_INFO(format(d));
  REQUIRE(report.defects.size() == 1);
  CHECK(report.defects[0].what.find('\n') == std::string::npos);
  CHECK(report.refused() == (report.defects[0].severity == Severity::refusal));
  return report.defects[0];
}

// Whether the report has a defect whose line has these words in it.
bool finds(const MeshReport& report, const std::string& words) {
  return std::any_of(report.defects.begin(), report.defects.end(),
                     [&](const Defect& d) { return format(d).find(words) != std::string::npos; });
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& x : mesh.positions) x *= factor;
  return mesh;
}

// Same vertices, upright: y is the longest extent.
TriangleMesh upright(TriangleMesh mesh) {
  for (Vec3& x : mesh.positions) std::swap(x.y(), x.z());
  return mesh;
}

}  // namespace

TEST_CASE("a good mesh is measured", "[examine]") {
  const MeshReport report = examine(grid(11, 6, 1, 0.5));
  CHECK(report.defects.empty());
  CHECK_FALSE(report.refused());
  CHECK(report.vertices == 66);
  CHECK(report.triangles == 100);
  CHECK(report.faces == 100);
  CHECK(report.edges == 66 + 100 - 1);
  CHECK(report.pieces == 1);
  CHECK(report.boundary_loops == 1);
  CHECK_FALSE(report.closed);
  CHECK(report.lower == Vec3(-0.5, 0, -0.25));
  CHECK(report.upper == Vec3(0.5, 0, 0.25));
  CHECK(report.area == Approx(0.5));
  CHECK(report.shortest_edge == Approx(0.1));
  CHECK(report.median_edge == Approx(0.1));
  CHECK(report.longest_edge == Approx(0.1 * std::sqrt(2.0)));
  CHECK(report.smallest_angle == Approx(std::acos(-1.0) / 4));
  CHECK(examine(sphere(2, 1)).closed);
  CHECK(examine(sphere(2, 1)).boundary_loops == 0);
}

TEST_CASE("every defect is found at its place", "[examine]") {
  TriangleMesh mesh = grid(4, 4, 1, 1);

  SECTION("three triangles at an edge") {
    mesh.positions.push_back({0, 1, 0});
    mesh.triangles.push_back({5, 6, 16});
    const Defect d = only_defect(mesh);
    CHECK(d.vertices == std::vector<int>{5, 6});
    CHECK_THAT(d.what, Contains("1 edge has more than two triangles"));
  }
  SECTION("a triangle turned round") {
    std::swap(mesh.triangles[9][0], mesh.triangles[9][1]);
    const Defect d = only_defect(mesh);
    CHECK_THAT(d.what, Contains("3 edges lie between triangles wound against each other"));
    std::vector<int> corners(mesh.triangles[9].begin(), mesh.triangles[9].end());
    std::sort(corners.begin(), corners.end());
    CHECK(d.vertices == corners);
  }
  SECTION("the same triangle again, the other way round") {
    mesh.triangles.push_back({mesh.triangles[3][2], mesh.triangles[3][1], mesh.triangles[3][0]});
    CHECK_THAT(only_defect(mesh).what, Contains("1 triangle has the same corners"));
    CHECK(examine(mesh).area == Approx(1));
  }
  SECTION("a vertex named twice") {
    mesh.triangles.push_back({3, 7, 3});
    const Defect d = only_defect(mesh);
    CHECK(d.vertices == std::vector<int>{3, 7});
    CHECK_THAT(d.what, Contains("1 triangle names a vertex twice"));
  }
  SECTION("vertices of no triangle") {
    mesh.positions.insert(mesh.positions.end(), 3, Vec3(9, 9, 9));
    const Defect d = only_defect(mesh);
    CHECK(d.vertices == std::vector<int>{16, 17, 18});
    CHECK(examine(mesh).upper.x() == 0.5);  // they do not count for the size
    CHECK(examine(mesh).pieces == 1);
  }
  SECTION("coincident, not joined") {
    TriangleMesh right = mesh;
    for (const Vec3& x : mesh.positions) right.positions.push_back(x + Vec3(1, 1e-12, 0));
    for (const Triangle& t : mesh.triangles) right.triangles.push_back({t[0] + 16, t[1] + 16, t[2] + 16});
    const Defect d = only_defect(right);
    CHECK(d.vertices == std::vector<int>{3, 7, 11, 15, 16, 20, 24, 28});
    CHECK_THAT(d.what, Contains("weld"));
    CHECK(examine(right).pieces == 2);
    for (std::size_t v = 16; v < 32; ++v) right.positions[v].x() += 1e-6;
    CHECK(examine(right).defects.empty());  // close, but not the same place
  }
  SECTION("coincident, joined by an edge") {
    mesh.positions[5] = mesh.positions[6];
    const MeshReport report = examine(mesh);
    CHECK(finds(report, "hold them together or make them one (vertices 5 and 6)"));
    CHECK(finds(report, "no area"));
    CHECK_FALSE(finds(report, "weld"));
    CHECK(report.shortest_edge == 0);
    CHECK(report.smallest_angle == 0);
    CHECK_FALSE(report.refused());
  }
  SECTION("a sliver") {
    mesh.positions.push_back(mesh.positions[0] + Vec3(0.2, 0, -1e-3));
    mesh.triangles.push_back({0, 1, 16});
    const MeshReport report = examine(mesh);
    CHECK(finds(report, "below 1 degree"));
    CHECK_FALSE(finds(report, "no area"));
    CHECK(report.smallest_angle < 0.01);
    CHECK(report.smallest_angle > 0.001);
  }
}

TEST_CASE("what the reader passed over is a warning", "[examine]") {
  const MeshReport report = examine(parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\n", "w.obj"));
  CHECK(finds(report, "warning: w.obj:4: "));
  const MeshReport quad = examine(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "q.obj"));
  CHECK(quad.faces == 1);
  CHECK(quad.triangles == 2);
  CHECK(quad.defects.empty());
}

TEST_CASE("only what cannot be simulated at all is refused", "[examine]") {
  TriangleMesh mesh = grid(3, 3, 1, 1);
  SECTION("no area") {
    for (Vec3& x : mesh.positions) x.z() = 0;
    CHECK(finds(examine(mesh), "refused: no triangle has an area"));
  }
  SECTION("all in one point") {
    for (Vec3& x : mesh.positions) x.setZero();
    CHECK(examine(mesh).refused());
  }
  SECTION("no triangles") {
    mesh.triangles.clear();
    CHECK(examine(mesh).refused());
  }
  SECTION("nothing") {
    mesh = TriangleMesh();
    CHECK(examine(mesh).refused());
  }
  SECTION("not finite") {
    mesh.positions[4].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK(only_defect(mesh).vertices == std::vector<int>{4});
    CHECK(examine(mesh).refused());
  }
  SECTION("a vertex that is not there") {
    mesh.triangles[2][1] = 9;
    CHECK_THAT(only_defect(mesh).what, Contains("vertex 9, but the mesh has 9"));
  }
}

TEST_CASE("a size that may be another unit is questioned", "[examine]") {
  const TriangleMesh metre = upright(grid(5, 5, 0.5, 1.7));
  const auto says = [&](double factor, const std::string& words) {
    const Defect d = only_defect(scaled(metre, factor));
    INFO(d.what);
    CHECK(d.severity == Severity::warning);
    CHECK_THAT(d.what, Contains(words));
  };
  says(100, "170 units tall");
  says(100, "are these centimetres? try scale = 0.01");
  says(1000, "are these millimetres? try scale = 0.001");
  says(10, "are these decimetres? try scale = 0.1");
  says(1e6, "give a scale");
  says(0.001, "try scale = 1000");
  says(0.01, "try scale = 100");
  CHECK(only_defect(scaled(grid(3, 3, 1.7, 1), 100)).what.find(" wide") != std::string::npos);
  for (const double fine : {0.02, 0.1, 1.0, 2.9}) CHECK(examine(scaled(metre, fine)).defects.empty());
}

TEST_CASE("the printed line names the first few places", "[examine]") {
  CHECK(format({Severity::note, "all well", {}}) == "note: all well");
  CHECK(format({Severity::warning, "one", {4}}) == "warning: one (vertex 4)");
  CHECK(format({Severity::warning, "three", {4, 9, 11}}) == "warning: three (vertices 4, 9 and 11)");
  CHECK(format({Severity::refusal, "seven", {1, 2, 3, 4, 5, 6, 7}}) ==
        "refused: seven (vertices 1, 2, 3, 4, 5 and 2 more)");
}

TEST_CASE("many vertices in one place are found quickly", "[examine]") {
  TriangleMesh mesh = grid(300, 300, 1, 1);  // 200,000 corners, none shared, in 90,000 places
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const int first = soup.vertex_count();
    for (const int v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.positions.insert(soup.positions.end(), 100000, Vec3::Zero());
  for (int v = soup.vertex_count() - 99999; v + 2 < soup.vertex_count(); v += 3)
    soup.triangles.push_back({v, v + 1, v + 2});
  const MeshReport report = examine(soup);
  CHECK(finds(report, "weld"));
  CHECK(finds(report, "no area"));
}

TEST_CASE("real files are counted as their manifest counts them", "[examine][shared]") {
  struct Count {
    std::string file;
    int triangles, pieces, boundary_loops, inconsistent, many, flat;
    double smallest_angle;  // degrees; -1: of polygons, which we cut otherwise
  };
  // Where faces are repeated the manifest counts every copy, and we count them once;
  // such files are not in this list.
  const std::vector<Count> counts = {
      {"dressed/mh_male_body.obj", 26756, 1, 0, 0, 0, 0, -1},
      {"dressed/mh_male_tee_jeans.obj", 3240, 2, 7, 0, 0, 0, -1},
      {"dressed/smpl_female_body.obj", 13776, 1, 0, 0, 0, 0, 2.2343053014857595},
      {"dressed/sew_tee_05079_sub2.obj", 7792, 1, 4, 168, 0, 0, 1.318683922696306},
      {"garments/dedo_tshirt_0.obj", 1106, 1, 4, 104, 0, 88, 0},
      {"garments/diffcloth_tshirt1900.obj", 3726, 1, 4, 0, 0, 0, 13.77990170735721},
      {"garments/female_elegantsuit01.obj", 4192, 2, 5, 20, 0, 0, -1},
      {"sheets/ring_16x64.obj", 1920, 1, 2, 0, 0, 0, -1},
      {"sheets/ngon_square_poly.obj", 10249, 1, 1, 0, 0, 0, -1},
      {"obstacles/codim_cylinder3K.obj", 5754, 3, 4, 0, 0, 0, -1},
      {"quirks/fan3.obj", 3, 1, 1, 0, 1, 0, -1},
      {"quirks/cornell_box.obj", 36, 18, 18, 0, 0, 0, -1},
      {"quirks/platonic_shelf.obj", 80, 5, 0, 0, 0, 0, -1}};
  const fs::path root = fs::path(test::shared_dir()) / "meshes";
  std::error_code missing;
  if (!fs::is_directory(root, missing)) {
    WARN("no shared meshes: skipped");
    return;
  }
  const auto edges_of = [](int n, const std::string& one, const std::string& many) {
    return std::to_string(n) + (n == 1 ? one : many);
  };
  for (const Count& c : counts) {
    INFO(c.file);
    const MeshReport report = examine(read_obj(root / c.file));
    for (const Defect& d : report.defects) UNSCOPED_INFO(format(d));
    CHECK(report.triangles == c.triangles);
    CHECK(report.pieces == c.pieces);
    CHECK(report.boundary_loops == c.boundary_loops);
    CHECK(finds(report, "wound against") == (c.inconsistent > 0));
    if (c.inconsistent > 0) CHECK(finds(report, edges_of(c.inconsistent, " edge lies", " edges lie")));
    CHECK(finds(report, "more than two") == (c.many > 0));
    if (c.many > 0) CHECK(finds(report, edges_of(c.many, " edge has", " edges have")));
    if (c.flat > 0) CHECK(finds(report, edges_of(c.flat, " triangle has no", " triangles have no")));
    if (c.smallest_angle >= 0)
      CHECK(report.smallest_angle * 180 / std::acos(-1.0) == Approx(c.smallest_angle).margin(1e-9));
    CHECK_FALSE(report.refused());
  }
  CHECK(finds(examine(read_obj(root / "garments/05079_tee_O2IVOZPFPE_sim.obj")), "centimetres"));
  CHECK(finds(examine(read_obj(root / "bodies/male_generic.obj")), "decimetres"));
  CHECK(finds(examine(read_obj(root / "obstacles/trimesh_chair.obj")), "the same corners"));
}
