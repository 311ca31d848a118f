// Real files, and tinyobjloader as an independent oracle: where it reads a file properly, it reads the same.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

#include "mesh/triangles/normals.h"
#include "tests/folder.h"
#include "tests/obj.h"
#include "tests/places.h"

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
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> shared_meshes(const std::string& folder) {
  std::vector<fs::path> files;
  const fs::path root = fs::path(shared_dir()) / "meshes";
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

}  // namespace

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
    require_like_tiny(content(file));
    ++compared;
  }
  CHECK((compared == 0 || compared > 40));
}

TEST_CASE("real files survive a round trip", "[obj][shared]") {
  for (const fs::path& file : good_meshes()) {
    INFO(file.filename().string());
    require_round_trip(content(file));
    const TriangleMesh mesh = read_obj(file);
    const ObjDocument& document = *mesh.document;
    if (document.warnings.empty())
      CHECK(mesh.triangles.size() == document.corners.size() - 2 * document.face_count());
    for (const Triangle& t : mesh.triangles) CHECK((t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
  }
}

TEST_CASE("files with quirks do what their manifest says", "[obj][shared]") {
  const fs::path folder = fs::path(shared_dir()) / "meshes" / "quirks";
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
