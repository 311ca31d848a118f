// An output folder read back: what was written is what is read, and what is damaged is told.
#include <catch2/catch.hpp>

#include "app/base/npy.h"
#include "app/base/pc2.h"
#include "app/recording/body_files.h"
#include "app/recording/recording.h"
#include "app/run/run.h"
#include "folder.h"
#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

namespace fs = std::filesystem;

// A sheet of five by five vertices falls on a ball that turns and a box that moves, over a floor.
constexpr const char* scene = R"(
[simulation]
duration = "0.25 s"
frame_rate = "20 Hz"
[[cloth]]
mesh = "sheet.obj"
[[obstacle]]
name = "ball"
shape = "sphere"
radius = "0.2 m"
centre = [0, -0.21, 0]
friction = 0.5
motion = { spin = { axis = [0, 1, 0], rate = "2 rad/s" }, velocity = [0.1, 0, 0] }
[[obstacle]]
name = "block"
shape = "box"
size = [0.1, 0.1, 0.1]
centre = [1, 0, 0]
motion = { velocity = [0, 1, 0] }
[[obstacle]]
shape = "plane"
point = [0, -1, 0]
)";

void write_sheet(const Folder& folder) {
  std::string text = "# a sheet\n";
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      text += "v " + std::to_string(0.1 * i - 0.2) + " 0 " + std::to_string(0.1 * j - 0.2) + "\n";
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const int v = 5 * i + j + 1;
      text += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " + std::to_string(v + 6) + " " +
              std::to_string(v + 5) + "\n";
    }
  folder.write("sheet.obj", text);
}

// Runs it into folder/out and folder/frames of the kind.
void run_into(const Folder& folder, const std::string& out, Frames frames) {
  write_sheet(folder);
  folder.write("scene.toml", scene);
  REQUIRE(run(read_scene(folder.path / "scene.toml", {}), {folder.path / out, frames, true}) == 0);
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

}  // namespace

TEST_CASE("frames as a point cache and as OBJ files are the same motion", "[recording]") {
  const Folder folder;
  run_into(folder, "cache", Frames::pc2);
  run_into(folder, "files", Frames::obj);
  const Recording cache(folder.path / "cache"), files(folder.path / "files");
  CHECK(cache.missing().empty());
  CHECK(files.missing().empty());
  REQUIRE(cache.frames() == 6);
  REQUIRE(files.frames() == 6);
  REQUIRE(cache.shapes().size() == 3);
  CHECK(cache.shapes()[0].name == "sheet");
  CHECK(cache.shapes()[1].body);
  CHECK(cache.frame_rate() == Approx(20));
  for (std::size_t shape = 0; shape < 3; ++shape)
    for (int frame = 0; frame < 6; ++frame) {
      CHECK(cache.time(frame) == Approx(0.05 * frame).margin(1e-9));
      CHECK(largest_difference(cache.positions(shape, frame), files.positions(shape, frame)) < 1e-6);
    }
  // The block rises by 1 m/s: its poses are put to use.
  CHECK((cache.positions(2, 5)[0] - cache.positions(2, 0)[0] - Vec3(0, 0.25, 0)).norm() < 1e-7);
  REQUIRE(cache.planes(0).size() == 1);
  CHECK((cache.planes(0)[0].point - Vec3(0, -1, 0)).norm() == 0);
  CHECK(cache.steps().rows.size() == 25);
  CHECK(cache.steps().columns.front() == "step");
  CHECK(cache.steps().rows.back()[1] == Approx(0.25));
}

TEST_CASE("faces of a recording are cut as in the run, however they are bent by then", "[recording]") {
  const Folder folder;
  run_into(folder, "out", Frames::pc2);
  const Recording recording(folder.path / "out");
  const TriangleMesh start = parse_obj(content(folder.path / "sheet.obj"), "sheet.obj");
  CHECK(recording.shapes()[0].mesh.triangles == start.triangles);
  // The last shape alone would be cut another way: that is what this is for.
  CHECK(parse_obj(content(folder.path / "out/sheet.obj"), "sheet.obj").triangles != start.triangles);
  folder.write("out/fields/sheet.triangles.npy", "nothing");
  CHECK(Recording(folder.path / "out").missing().size() == 1);
  // A later run into the same folder whose faces need no cutting.
  folder.write("sheet.obj", "v 0 0 0\nv 0 0 0.1\nv 0.1 0 0.1\nv 0.1 0 0\nf 1 2 4\nf 2 3 4\n");
  REQUIRE(run(read_scene(folder.path / "scene.toml", {}), {folder.path / "out", Frames::pc2, true}) == 0);
  const Recording later(folder.path / "out");
  CHECK(later.missing().empty());
  CHECK(later.shapes()[0].mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}});
}

TEST_CASE("velocities, strains and contacts are those of the frame", "[recording]") {
  const Folder folder;
  run_into(folder, "out", Frames::pc2);
  const Recording recording(folder.path / "out");
  // Falling free at first: the velocity is g t.
  const std::vector<Vec3> first = recording.velocities(0, 0);
  REQUIRE(first.size() == 25);
  for (const Vec3& v : first) CHECK(v.norm() == 0);
  for (const app::Touch touch : recording.touches(0, 0)) CHECK(touch == app::Touch::free);
  bool touched = false;
  for (int frame = 0; frame < recording.frames(); ++frame) {
    for (const app::Touch touch : recording.touches(0, frame)) touched = touched || touch != app::Touch::free;
    // l / L - 1 of the edges of quads, whose rest lengths are 10 cm; diagonals of quads are edges, too.
    const std::vector<Vec3> x = recording.positions(0, frame);
    const std::vector<double> strain = recording.strains(0, frame);
    for (std::size_t i = 0; i < 25; ++i) {
      double most = 0;  // whichever way
      for (std::size_t j : {i - 1, i + 1, i - 5, i + 5})
        if (j < 25 && (i / 5 == j / 5 || i % 5 == j % 5))
          most = std::max(most, std::abs((x[i] - x[j]).norm() / 0.1 - 1));
      CHECK(std::abs(strain[i]) >= most - 1e-5);
      CHECK(strain[i] < 0.1);
    }
  }
  CHECK(touched);
  CHECK(recording.velocities(1, 0).empty());  // of a body none is recorded
}

TEST_CASE("NumPy reads the arrays", "[recording]") {
  const Folder folder;
  if (folder.shell("/usr/bin/python3 -c 'import numpy'").exit_code != 0) {
    WARN("skipped: there is no NumPy");
    return;
  }
  NpyWriter writer(folder.path / "a.npy", NpyWriter::Kind::float32, {2, 3});
  writer.add(std::vector<float>{1, 2, 3, 4, 5, 6});
  writer.add(std::vector<float>{-0.5f, 0, 1e-30f, 1e30f, 7, 8});
  writer.close();
  writer.keep();
  const Outcome said = folder.shell(
      "/usr/bin/python3 -c \"import numpy as np; a = np.load('a.npy', mmap_mode='r'); print(a.shape, "
      "a.dtype, "
      "float(a[1, 0, 0]), float(a[0, 1, 2]), float(a[1, 0, 2]) == float(np.float32(1e-30)))\"");
  CHECK(said.out == "(2, 2, 3) float32 -0.5 6.0 True\n");
  NpyReader reader(folder.path / "a.npy");
  CHECK(reader.frame(1) == std::vector<float>{-0.5f, 0, 1e-30f, 1e30f, 7, 8});
}

TEST_CASE("what is missing or damaged is told, and the rest is there", "[recording]") {
  const Folder folder;
  run_into(folder, "out", Frames::pc2);
  const fs::path out = folder.path / "out";
  const auto told = [&](const std::string& words) {
    const Recording recording(out);
    INFO(words);
    REQUIRE(recording.missing().size() == 1);
    INFO(recording.missing().front());
    CHECK(recording.missing().front().find(words) != std::string::npos);
    CHECK(!recording.shapes().empty());
    CHECK(recording.positions(0, 0).size() == 25);
    CHECK_THROWS_AS(recording.require_whole(), InputError);
    return recording.frames();
  };
  SECTION("a point cache cut short") {
    fs::resize_file(out / "sheet.pc2", 32 + 3 * 25 * 12 + 5);
    CHECK(told("sheet.pc2: is cut short: it holds 3 whole samples of the 6") == 3);
  }
  SECTION("no point cache") {
    fs::remove(out / "sheet.pc2");
    CHECK(told("sheet.pc2: is missing") == 1);
  }
  SECTION("steps cut short") {
    fs::resize_file(out / "steps.csv", fs::file_size(out / "steps.csv") - 40);
    CHECK(told("steps.csv:26: has") == 6);
  }
  SECTION("run.json cut short") {
    fs::resize_file(out / "run.json", 200);
    CHECK(told("run.json:") == 6);
  }
  SECTION("no run.json") {
    fs::remove(out / "run.json");
    CHECK(told("run.json: is missing") == 6);
  }
  SECTION("a field cut short") {
    fs::resize_file(out / "fields" / "sheet.strain.npy", 200);
    CHECK(told("sheet.strain.npy: has not the size") == 6);
    CHECK(Recording(out).strains(0, 2).empty());
    CHECK(Recording(out).velocities(0, 2).size() == 25);
  }
  SECTION("a field that is gone") {
    fs::remove(out / "fields" / "sheet.contact.npy");
    CHECK(told("sheet.contact.npy: is missing") == 6);
  }
  SECTION("a field of another shape") {
    NpyWriter writer(out / "fields" / "sheet.velocity.npy", NpyWriter::Kind::float32, {25});
    for (int frame = 0; frame < 6; ++frame) writer.add(std::vector<float>(25, 1));
    writer.close();
    writer.keep();
    CHECK(told("sheet.velocity.npy: has other numbers in a frame") == 6);
    CHECK(Recording(out).velocities(0, 2).empty());
  }
  SECTION("times that are none") {
    const std::string before = content(out / "run.json");
    const std::size_t at = before.find("0.05,");
    folder.write("out/run.json", before.substr(0, at) + "null," + before.substr(at + 5));
    CHECK(told("frame_times are not times that rise") == 6);
  }
  SECTION("a body's shape") {
    fs::remove(out / "bodies" / "block.obj");
    CHECK(told("block.obj") == 6);
    CHECK(Recording(out).shapes().size() == 2);
  }
}

TEST_CASE("files of another run in the same folder are not taken for this run's", "[recording]") {
  const Folder folder;
  const std::vector<Frames> kinds = {Frames::pc2, Frames::obj, Frames::none};
  for (const Frames first : kinds)
    for (const Frames second : kinds) {
      INFO("kinds " << int(first) << " and " << int(second));
      // The first is longer, its sheet lies elsewhere, and its block moves; the second's block stands.
      write_sheet(folder);
      std::string other = scene;
      other.replace(other.find("0.25 s"), 6, "0.35 s");
      other.replace(other.find("mesh ="), 6, "translate = [0, 3, 0]\nmesh =");
      folder.write("first.toml", other);
      std::string standing = scene;
      standing.erase(standing.find("motion = { velocity = [0, 1, 0] }"), 33);
      folder.write("second.toml", standing);
      std::filesystem::remove_all(folder.path / "out");
      const fs::path out = folder.path / "out", alone = folder.path / "alone";
      REQUIRE(run(read_scene(folder.path / "first.toml", {}), {out, first, true}) == 0);
      REQUIRE(run(read_scene(folder.path / "second.toml", {}), {out, second, true}) == 0);
      REQUIRE(run(read_scene(folder.path / "second.toml", {}), {alone, second, true}) == 0);
      const Recording both(out), fresh(alone);
      CHECK(both.missing().empty());
      REQUIRE(both.frames() == fresh.frames());
      CHECK(both.frames() == (second == Frames::none ? 1 : 6));
      for (int frame = 0; frame < both.frames(); ++frame) {
        CHECK(both.time(frame) == fresh.time(frame));
        CHECK(both.velocities(0, frame) == fresh.velocities(0, frame));
        for (std::size_t shape = 0; shape < 3; ++shape)
          CHECK(both.positions(shape, frame) == fresh.positions(shape, frame));
      }
      std::filesystem::remove_all(alone);
    }
}

TEST_CASE("a plane that rises is where it is, with frames and without", "[recording]") {
  const Folder folder;
  write_sheet(folder);
  folder.write("scene.toml",
               "[simulation]\nduration = 0.1\n[[cloth]]\nmesh = \"sheet.obj\"\n[[obstacle]]\nname = \"a "
               "table/top\"\nshape = "
               "\"plane\"\npoint = [0, -0.5, 0]\nmotion = { velocity = [0, 1, 0] }\n");
  for (const Frames kind : {Frames::pc2, Frames::none}) {
    REQUIRE(run(read_scene(folder.path / "scene.toml", {}), {folder.path / "out", kind, true}) == 0);
    const Recording recording(folder.path / "out");
    const int last = recording.frames() - 1;
    CHECK(recording.missing().empty());  // whatever the plane is called
    CHECK(recording.planes(last)[0].point[1] == Approx(-0.5 + recording.time(last)));
  }
}

TEST_CASE("a body's damaged cache and frames of another mesh are told", "[recording]") {
  const Folder folder;
  write_sheet(folder);
  folder.write("ball_1.obj",
               "v -1 -1 -1\nv 1 -1 -1\nv 0 -1 1\nv 0 -0.5 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n");
  folder.write("ball_2.obj",
               "v -1 -1 -1\nv 1 -1 -1\nv 0 -1 1\nv 0 -0.4 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n");
  folder.write(
      "scene.toml",
      "[simulation]\nduration = 0.2\n[[cloth]]\nmesh = \"sheet.obj\"\n[[obstacle]]\nname = "
      "\"ball\"\nshape = \"mesh\"\nmesh = \"ball_1.obj\"\nframes = \"ball_%d.obj\"\nframe_rate = 10\n");
  const Scene described = read_scene(folder.path / "scene.toml", {});
  const fs::path out = folder.path / "out";
  REQUIRE(run(described, {out, Frames::pc2, true}) == 0);
  REQUIRE(Recording(out).missing().empty());
  CHECK(Recording(out).positions(1, 5)[3][1] == Approx(-0.4));
  fs::resize_file(out / "bodies" / "ball.pc2", 32 + 2 * 4 * 12 + 1);
  const Recording damaged(out);
  REQUIRE(damaged.missing().size() == 1);
  CHECK(damaged.missing()[0].find("ball.pc2: is cut short") != std::string::npos);
  CHECK(damaged.frames() == 2);

  REQUIRE(run(described, {out, Frames::obj, true}) == 0);
  folder.write("out/frames/sheet_0002.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK_THROWS_WITH(Recording(out).positions(0, 1), Catch::Contains("sheet_0002.obj: has 3 vertices"));
}

TEST_CASE("JSON that is deep or out of range is refused in one line", "[recording]") {
  for (const std::string& text : {std::string(200000, '['), std::string("[1e999]"), std::string("{\"a\": ")})
    CHECK_THROWS_AS(parse_json(text, "run.json"), InputError);
  CHECK(parse_json(std::string(100, '[') + std::string(100, ']'), "a").items().size() == 1);
}

TEST_CASE("names in run.json do not lead out of the folder", "[recording]") {
  const Folder folder;
  run_into(folder, "out", Frames::pc2);
  for (const char* name : {"../sheet", "/sheet", ".sheet", ""}) {
    std::string text = content(folder.path / "out/run.json");
    text.replace(text.find("\"sheet\""), 7, "\"" + std::string(name) + "\"");
    folder.write("out/run.json", text);
    const Recording recording(folder.path / "out");
    REQUIRE_FALSE(recording.missing().empty());
    CHECK(recording.missing()[0].find("is no name of a file") != std::string::npos);
    for (const RecordedShape& shape : recording.shapes()) CHECK(shape.body);
    run_into(folder, "out", Frames::pc2);
  }
}

TEST_CASE("places of bodies that are lost are told", "[recording]") {
  const Folder folder;
  run_into(folder, "out", Frames::pc2);
  fs::remove(folder.path / "out" / "bodies.csv");
  const Recording recording(folder.path / "out");
  REQUIRE(recording.missing().size() == 2);  // the ball and the block
  CHECK(recording.missing()[1].find("has 0 places of 'block', expected 6") != std::string::npos);
  run_into(folder, "out", Frames::pc2);
  const std::string all = content(folder.path / "out/bodies.csv");  // a header and six rows of each
  folder.write("out/bodies.csv", all.substr(0, all.rfind('\n', all.size() - 2) + 1));
  const Recording shorter(folder.path / "out");
  REQUIRE(shorter.missing().size() == 1);
  CHECK(shorter.missing()[0].find("has 5 places of") != std::string::npos);
}

TEST_CASE("a folder with nothing to show is refused", "[recording]") {
  const Folder folder;
  folder.write("body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");  // a mesh makes no run
  CHECK_THROWS_AS(Recording(folder.path), InputError);
  CHECK_THROWS_AS(Recording(folder.path / "none"), InputError);
  run_into(folder, "out", Frames::none);
  const Recording last(folder.path / "out");  // without frames: the last state is the only one
  CHECK(last.missing().empty());
  CHECK(last.frames() == 1);
  CHECK(last.time(0) == Approx(0.25));
}
