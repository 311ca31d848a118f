// What `drape export` writes is what the run computed, in every format; and what it refuses.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/base/markup.h"
#include "app/export/export.h"
#include "app/export/faces.h"
#include "app/export/files.h"
#include "app/export/gltf_buffer.h"
#include "app/export/mdd.h"
#include "app/export/ply.h"
#include "app/export/rigid.h"
#include "app/export/source.h"
#include "app/export/usda.h"
#include "app/export/vtk.h"
#include "app/recording/recording.h"
#include "app/recording/run_files.h"
#include "export_readers.h"
#include "exported.h"
#include "mesh/obj/obj.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string& cloth = exported_cloth;

// In float32, in the same order.
void check_same(const Places& found, const Recording& recording, std::size_t shape, double tolerance) {
  REQUIRE(found.size() == static_cast<std::size_t>(recording.frames()));
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::vector<Vec3> expected = recording.positions(shape, static_cast<int>(k));
    REQUIRE(found[k].size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      INFO("frame " << k << ", vertex " << i);
      REQUIRE((found[k][i] - expected[i]).cwiseAbs().maxCoeff() <= tolerance);
    }
  }
}

std::size_t number_of(const Recording& recording, const std::string& name) {
  for (std::size_t s = 0; s < recording.shapes().size(); ++s)
    if (recording.shapes()[s].name == name) return s;
  FAIL("no shape " + name);
  return 0;
}

}  // namespace

TEST_CASE("a LightWave point cache has the published layout", "[export]") {
  const std::string bytes = mdd_header({0, 0.5}, 3) + mdd_frame({{1, -2, 0.1}});
  const std::string expected(
      "\x00\x00\x00\x02\x00\x00\x00\x03"  // frames, points
      "\x00\x00\x00\x00\x3f\x00\x00\x00"  // 0 s, 0.5 s
      "\x3f\x80\x00\x00\xc0\x00\x00\x00\x3d\xcc\xcc\xcd",
      28);
  CHECK(bytes == expected);
}

TEST_CASE("every format holds every vertex of every frame in order", "[export]") {
  const Exported folder;
  for (const std::string& format : export_formats()) REQUIRE(folder.exported("run", format).exit_code == 0);
  const Recording recording(folder.path / "run");
  const double half_ulp = 1e-7;  // of places within 2 m
  REQUIRE(recording.frames() == 6);
  const std::vector<std::vector<int>> quad_rows{{0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}};
  for (const std::string& name : {cloth, std::string("wall")}) {
    const std::size_t s = number_of(recording, name);
    check_same(read_mdd(folder.file("mdd/" + name + ".mdd")), recording, s, half_ulp);
    Places glb = read_glb(folder.file("gltf/run.glb"), name);
    CHECK(glb.front().size() == (name == "wall" ? 10 : 16));  // its edges are hard
    for (std::vector<Vec3>& places : glb) places.resize(recording.shapes()[s].mesh.positions.size());
    check_same(glb, recording, s, half_ulp);
    check_same(read_usda(folder.file("usda/run.usda"), usd_names({name}).front()), recording, s, half_ulp);
    Places obj, ply, vtp;
    for (std::size_t k = 1; k <= 6; ++k) {
      obj.push_back(read_obj(folder.path / "obj" / numbered(name, k, ".obj")).positions);
      const ReadPolygons of_ply = read_ply(folder.file("ply/" + numbered(name, k, ".ply")));
      const ReadPolygons of_vtp = read_vtp(folder.file("vtk/" + numbered(name, k, ".vtp")));
      ply.push_back(of_ply.places);
      vtp.push_back(of_vtp.places);
      CHECK(of_ply.faces == of_vtp.faces);
      if (name != cloth) continue;
      CHECK(of_ply.faces.size() == 9);
      CHECK(std::equal(quad_rows.begin(), quad_rows.end(), of_ply.faces.begin()));
      REQUIRE(of_ply.uv.size() == 16);
      CHECK(of_ply.uv[6] == std::array<float, 2>{2 / 3.0f, 1 / 3.0f});
    }
    for (const Places* places : {&obj, &ply, &vtp}) check_same(*places, recording, s, half_ulp);
  }
  check_same(read_table(folder.file("csv/" + cloth + ".csv")), recording, 0, half_ulp);
  check_same(read_mdd(folder.file("mdd/ball.mdd")), recording, number_of(recording, "ball"), half_ulp);
  CHECK_FALSE(fs::exists(folder.path / "mdd/box.mdd"));  // it stands
  CHECK(fs::exists(folder.path / "ply/box.ply"));
}

TEST_CASE("what an export says it writes is all that it writes", "[export]") {
  const Exported folder;
  for (const std::string& format : export_formats()) {
    const Outcome outcome = folder.exported("run", format, "--every 2");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    std::size_t told = 0;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("wrote ")) continue;
      const std::size_t several = line.find(", 3 files");
      told += several == line.npos ? 1 : 3;
      const std::string first = line.substr(6, line.find(several == line.npos ? "\n" : " to ") - 6);
      CHECK(fs::exists(folder.path / first));
    }
    CHECK(told == folder.files(format).size());
  }
  // The first, third and fifth frame of six.
  const Recording recording(folder.path / "run");
  const Places places = read_mdd(folder.file("mdd/wall.mdd"));
  REQUIRE(places.size() == 3);
  CHECK((places[2][3] - recording.positions(number_of(recording, "wall"), 4)[3]).norm() < 1e-6);
  CHECK(Bytes{folder.file("mdd/wall.mdd"), true}.number(16) == Approx(0.16));
}

TEST_CASE("names are escaped in XML, USD and JSON", "[export]") {
  CHECK(escaped("a&b<c>\"d\"é") == "a&amp;b&lt;c&gt;&quot;d&quot;é");
  CHECK(usd_string("a\"b\\c") == "\"a\\\"b\\\\c\"");
  CHECK(usd_names({"a b", "a_b", "7", "", "a b"}) == Names{"a_b", "a_b_2", "_7", "_", "a_b_3"});
  const Exported folder;
  REQUIRE(folder.drape("export run --to vtk -o e").exit_code == 0);
  const std::string pvd = folder.file("e/run.pvd");
  CHECK_THAT(pvd, Contains("file=\"a &amp; &quot;b&quot; &lt;c&gt; é_0001.vtp\""));
  CHECK(fs::exists(folder.path / "e" / (cloth + "_0001.vtp")));
}

TEST_CASE("a run that kept no frames is exported as one", "[export]") {
  const Exported folder;
  REQUIRE(folder.drape("simulate scene.toml --out still --frames none --quiet").exit_code == 0);
  for (const std::string& format : export_formats()) {
    const Outcome outcome = folder.exported("still", format);
    INFO(format << outcome.err);
    CHECK(outcome.exit_code == 0);
  }
  const std::string glb = folder.file("gltf/still.glb");
  CHECK_THAT(glb, !Contains("animations") && !Contains("targets"));
  const Recording recording(folder.path / "still");
  check_same(read_glb(glb, cloth), recording, 0, 1e-7);
  check_same(read_mdd(folder.file("mdd/" + cloth + ".mdd")), recording, 0, 1e-7);
}

TEST_CASE("a body that moves as a whole gives its motion, one that deforms gives none", "[export]") {
  const Exported folder;
  const Recording recording(folder.path / "run");
  const ExportSource source = export_source(recording, 1);
  CHECK_FALSE(rigid_places(source, number_of(recording, "wall")));
  const std::size_t ball = number_of(recording, "ball");
  const auto places = rigid_places(source, ball);
  REQUIRE(places);
  const std::vector<Vec3> first = source.positions(ball, 0);
  for (std::size_t k = 0; k < source.frame_count(); ++k) {
    const RigidPlace& place = (*places)[k];
    if (k > 0) CHECK(place.turn.dot((*places)[k - 1].turn) > 0);
    const std::vector<Vec3> now = source.positions(ball, k);
    for (std::size_t i = 0; i < now.size(); ++i) {
      REQUIRE((place.turn * (first[i] - places->front().centre) + place.centre - now[i]).norm() < 1e-6);
    }
  }
  CHECK(2 * std::acos((*places)[5].turn.w()) == Approx(9 * 0.2).epsilon(1e-3));
}

TEST_CASE("a vertex with two uv is doubled after the others, and no uv is lost", "[export]") {
  // Two quads with a common edge, whose uv there differ; vertex 6 is in no face.
  const TriangleMesh mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 9 9 9\nvt 0 0\nvt 0.5 0\nvt 0 1\nvt 0.5 1\nvt "
      "0.6 0\nvt 1 0\n"
      "vt 0.6 1\nvt 1 1\nf 1/1 2/2 5/4 4/3\nf 2/5 3/6 6/8 5/7\nf 1/1 1/1 2/2\n",
      "seam.obj");
  const Faces faces = faces_of(mesh);
  CHECK(faces.counts == std::vector<int>{4, 4, 3});
  CHECK(faces.corners == std::vector<int>{0, 1, 4, 3, 1, 2, 5, 4, 0, 0, 1});
  CHECK(uv_by_vertex(faces, 7).empty());
  const Corners split = split_corners(mesh, faces, M_PI);
  REQUIRE(split.origin.size() == 9);
  for (int v = 0; v < 7; ++v) CHECK(split.origin[v] == v);
  REQUIRE(split.triangles.size() == mesh.triangles.size());
  for (std::size_t t = 0; t < split.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(split.triangles[t][k]);
      CHECK(split.origin[v] == mesh.triangles[t][k]);
      const double x = mesh.positions[split.origin[v]][0];
      const double right = t < 2 ? 0.5 * x : 0.6 + 0.4 * (x - 1);
      CHECK(split.uv[v][0] == Approx(right));
    }
}

TEST_CASE("hard edges of a body keep a normal on each side, smooth ones share it", "[export]") {
  const TriangleMesh cube = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 "
      "5\nf 3 7 8 4\n"
      "f 1 5 7 3\nf 2 4 8 6\n",
      "cube.obj");
  const Corners hard = split_corners(cube, faces_of(cube), crease_of(true));
  CHECK(hard.size() == 24);
  const std::vector<Vec3> normals = normals_of(hard, cube.positions);
  for (const Triangle& t : hard.triangles) {
    const auto x = [&](int v) { return cube.positions[hard.origin[v]]; };
    const Vec3 face = (x(t[1]) - x(t[0])).cross(x(t[2]) - x(t[0])).normalized();
    for (const int v : t) CHECK((normals[v] - face).norm() < 1e-12);
  }
  const Corners smooth = split_corners(cube, faces_of(cube), crease_of(false));
  CHECK(smooth.size() == 8);
  const std::vector<Vec3> outwards = normals_of(smooth, cube.positions);
  for (std::size_t v = 0; v < 8; ++v) CHECK(outwards[v].dot(cube.positions[v] - Vec3(0.5, 0.5, 0.5)) > 0.5);
}

TEST_CASE("a normal does not break where the uv do", "[export]") {
  const TriangleMesh bent = parse_obj(
      "v 0 0 0\nv 1 0 1\nv 2 0 0\nv 0 1 0\nv 1 1 1\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 5/4 "
      "4/3\nf 2/1 3/2 6/4 "
      "5/3\n",
      "bent.obj");
  const Corners split = split_corners(bent, faces_of(bent), crease_of(false));
  REQUIRE(split.size() == 8);
  const std::vector<Vec3> normals = normals_of(split, bent.positions);
  for (std::size_t v = 6; v < 8; ++v) CHECK((normals[v] - normals[split.origin[v]]).norm() == 0);
}

TEST_CASE("a polygon of more corners than a byte counts is kept", "[export]") {
  Faces faces;
  std::vector<Vec3> places;
  for (int v = 0; v < 300; ++v) {
    faces.corners.push_back(v);
    places.emplace_back(v, 0, 0);
  }
  faces.counts = {300};
  const ReadPolygons read = read_ply(ply_bytes(places, {}, faces, 0));
  REQUIRE(read.faces.size() == 1);
  CHECK(read.faces[0] == faces.corners);
}

TEST_CASE("a glTF file that would not fit its own header is refused", "[export]") {
  CHECK_NOTHROW(glb_start("{}", 1000, "a.glb"));
  CHECK_THROWS_WITH(glb_start("{}", 4'294'967'290u, "a.glb"), Contains("a.glb") && Contains("--every"));
}

TEST_CASE("of frames at one time the first is exported, so that times rise", "[export]") {
  const Exported folder;
  REQUIRE(folder.drape("simulate scene.toml --out dense --quiet --set simulation.frame_rate='\"250 Hz\"'")
              .exit_code == 0);
  // As if frames were the first states after their times, in steps of 10 ms.
  nlohmann::json run = nlohmann::json::parse(folder.file("dense/run.json"));
  for (nlohmann::json& time : run["frame_times"])
    time = std::ceil(std::max(0.0, time.get<double>() / 0.01 - 1e-9)) * 0.01;
  folder.write("dense/run.json", run.dump());
  const Recording recording(folder.path / "dense");
  const ExportSource source = export_source(recording, 1);
  REQUIRE(source.frame_count() == 21);  // 0.2 s in steps of 10 ms, and the start
  CHECK(source.skipped == recording.frames() - 21);
  CHECK(source.skipped > 20);
  for (std::size_t k = 1; k < source.frame_count(); ++k) {
    CHECK(source.time(k) == Approx(source.time(k - 1) + 0.01));
    const int before = source.frames[k] - 1;
    CHECK(recording.time(before) < source.time(k));
  }
  CHECK(usual_frame_rate(source) == Approx(100));

  for (const std::string format : {"gltf", "usda", "mdd"}) {
    const Outcome outcome = folder.exported("dense", format);
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.err, Catch::StartsWith("note: " + std::to_string(source.skipped) + " frames"));
  }
  CHECK(read_mdd(folder.file("mdd/wall.mdd")).size() == 21);
  CHECK(read_glb(folder.file("gltf/dense.glb"), "wall").size() == 21);
  // Keys of USD are whole codes, each once.
  const std::string usda = folder.file("usda/dense.usda");
  CHECK_THAT(usda, Contains("timeCodesPerSecond = 100\n"));
  std::istringstream lines(usda.substr(usda.find("point3f[] points.timeSamples")));
  std::string line;
  std::getline(lines, line);
  for (int code = 0; code <= 20; ++code) {
    std::getline(lines, line);
    CHECK(line.substr(0, line.find(':')) == "            " + std::to_string(code));
  }
  CHECK(folder.exported("run", "csv").err.empty());
}
