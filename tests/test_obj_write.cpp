// Laws of the OBJ writer: nothing is lost, normals are computed anew, a file is whole or the older one stays.
#include <catch2/catch.hpp>
#include <filesystem>

#include "mesh/triangles/generate.h"
#include "tests/folder.h"
#include "tests/obj.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

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

TEST_CASE("files that cannot be read or written say so in one line", "[obj]") {
  const Folder desk;
  const fs::path& folder = desk.path;
  CHECK_THROWS_WITH(read_obj(folder / "none.obj"), Contains("none.obj") && Contains("no such file"));
  CHECK_THROWS_WITH(read_obj(folder), Contains("is a directory"));
  desk.write("empty.obj", "");
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
  CHECK(read_obj(folder / "grid.obj").positions == mesh.positions);       // the older one is still there
  CHECK(desk.files() == std::set<std::string>{"empty.obj", "grid.obj"});  // no temporary files left
}
