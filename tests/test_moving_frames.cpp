// The frames of a deforming body: in between, before and after; their files, and what is wrong with them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "app/base/pc2.h"
#include "app/recording/output.h"
#include "app/simulation/simulation.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

namespace {

using Places = std::vector<Vec3>;

const TriangleMesh rest = box_mesh({0.4, 0.2, 0.3});

// The rest mesh, carried off by some quadratic way.
TriangleMesh frame(int k) {
  TriangleMesh mesh = rest;
  for (Vec3& x : mesh.positions) x += Vec3(0.25 * k, 0.125 * k * k, 0);
  return mesh;
}

// A folder with a cloth, a body and five frames of it as walk/body_0001.obj and so on, and as walk.pc2.
struct Walk : Folder {
  Walk() {
    std::filesystem::create_directory(path / "walk");
    const TriangleMesh sheet = grid(4, 4, 0.3, 0.3);
    write_obj(path / "sheet.obj", sheet, sheet.positions);
    write_obj(path / "body.obj", rest, rest.positions);
    Pc2Writer cache(path / "walk.pc2", rest.vertex_count());
    for (int k = 0; k < 5; ++k) {
      const TriangleMesh mesh = frame(k);
      write_obj(path / "walk" / ("body_000" + std::to_string(k + 1) + ".obj"), mesh, mesh.positions);
      cache.add(mesh.positions);
    }
    cache.close();
    cache.keep();
  }

  std::string scene(const std::string& keys) const {
    write("s.toml",
          "[[cloth]]\nmesh = \"sheet.obj\"\ntranslate = [0, 1, 0]\n[[obstacle]]\nshape = \"mesh\"\nmesh = "
          "\"body.obj\"\n" +
              keys);
    return (path / "s.toml").string();
  }
  Simulation simulation(const std::string& keys) const {
    return make_simulation(read_scene(scene(keys), {}));
  }
  Shape body(const std::string& keys) const {
    return simulation(keys).constraints->bodies().front().obstacle().shape;
  }
};

Vec3 first_vertex(Shape& body, double time) {
  move(body, time, time);
  const SurfaceDistance& surface = *std::get<DeformingBody>(body).surface;
  return surface.place({rest.triangles[0], Vec3::UnitX(), Vec3::Zero()}, 0);
}

}  // namespace

TEST_CASE("frames: straight in between, and the body stands before and after", "[moving]") {
  MeshFrames frames;
  const Places a = {{0, 0, 0}, {1, 2, 3}}, b = {{1, 0, 0}, {1, 4, 3}}, c = {{1, 0, 8}, {-1, 4, 3}};
  frames.add(0.5, a);
  frames.add(1, b);
  frames.add(3, c);
  Places at;
  for (const auto& [time, first, second] :
       std::vector<std::tuple<double, Vec3, Vec3>>{{-1, a[0], a[1]},
                                                   {0.5, a[0], a[1]},
                                                   {0.75, {0.5, 0, 0}, {1, 3, 3}},
                                                   {1, b[0], b[1]},
                                                   {1.5, {1, 0, 2}, {0.5, 4, 3}},
                                                   {3, c[0], c[1]},
                                                   {99, c[0], c[1]}}) {
    frames.positions_at(time, at);
    CHECK(at == Places{first, second});
  }
  CHECK(frames.frame_count() == 3);
  CHECK_THROWS_WITH(frames.add(3, a), Contains("later") && Contains("at 3 s"));
  CHECK_THROWS_WITH(frames.add(4, {{0, 0, 0}}), Contains("1 vertices") && Contains("2"));
  CHECK_THROWS_WITH(frames.add(4, {{0, 0, 0}, {0, std::nan(""), 0}}), Contains("vertex 1"));
  CHECK_THROWS_WITH(frames.add(4, {{0, 0, 0}, {0, 1e300, 0}}), Contains("vertex 1"));
}

TEST_CASE("a pattern, a list and a point cache are the same body", "[moving]") {
  const Walk walk;
  for (const std::string frames :
       {"\"walk/body_%04d.obj\"", "\"walk.pc2\"",
        "[\"walk/body_0001.obj\", \"walk/body_0002.obj\", \"walk/body_0003.obj\", \"walk/body_0004.obj\", "
        "\"walk/body_0005.obj\"]"}) {
    INFO(frames);
    Shape body =
        walk.body("frames = " + std::string(frames) + "\nframe_rate = \"10 Hz\"\nframes_start = \"1 s\"\n");
    const Vec3 x = rest.positions[rest.triangles[0][0]];
    CHECK(std::get<DeformingBody>(body).frames->frame_count() == 5);
    CHECK((first_vertex(body, 0) - x).norm() < 1e-7);
    CHECK((first_vertex(body, 1.05) - x - Vec3(0.125, 0.0625, 0)).norm() < 1e-7);
    CHECK((first_vertex(body, 1.4) - x - Vec3(1, 2, 0)).norm() < 1e-6);
    CHECK((first_vertex(body, 9) - x - Vec3(1, 2, 0)).norm() < 1e-6);
  }
}

TEST_CASE("frames come at 25 Hz from 0 s, and are placed as the rest mesh is", "[moving]") {
  const Walk walk;
  Shape body = walk.body(
      "frames = \"walk.pc2\"\nscale = 2\nrotate = { axis = [0, 0, 1], angle = \"90 deg\" }\ntranslate = [0, "
      "0, 1]\n");
  const Vec3 x = frame(2).positions[rest.triangles[0][0]];
  CHECK((first_vertex(body, 2 / 25.0) - Vec3(-2 * x.y(), 2 * x.x(), 2 * x.z() + 1)).norm() < 1e-6);
}

TEST_CASE("numbers of frames begin where the files do", "[moving]") {
  const Walk walk;
  std::filesystem::rename(walk.path / "walk/body_0001.obj", walk.path / "walk/b9.obj");
  std::filesystem::rename(walk.path / "walk/body_0002.obj", walk.path / "walk/b10.obj");
  std::filesystem::copy(walk.path / "walk/b10.obj", walk.path / "walk/b011.obj");  // not what %d writes
  Shape body = walk.body("frames = \"walk/b%d.obj\"\n");
  CHECK(std::get<DeformingBody>(body).frames->frame_count() == 2);
}

TEST_CASE("frames that are wrong are told with their file", "[moving]") {
  const Walk walk;
  const auto refused = [&](const std::string& frames) {
    try {
      walk.simulation("frames = " + frames + "\n");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was thrown");
  };
  const std::string pattern = "\"walk/body_%04d.obj\"", cache = "\"walk.pc2\"";
  CHECK_THAT(refused("\"walk/body.obj\""), Contains("s.toml:7: frames") && Contains("%04d"));
  for (const char* bad : {"\"walk/%d_%d.obj\"", "\"walk/%s.obj\"", "\"walk/%4d.obj\"", "[]", "\"\"", "3"})
    CHECK_THAT(refused(bad), Contains("s.toml:7: frames"));
  CHECK_THAT(refused("\"run/body_%04d.obj\""), Contains("no file such as") && Contains("run/body_0001.obj"));
  CHECK_THAT(refused("[\"walk/body_0001.obj\", \"walk/body_0009.obj\"]"),
             Contains("body_0009.obj: no such file"));
  CHECK_THAT(refused("\"none.pc2\""), Contains("none.pc2: no such file"));
  CHECK_THAT(refused("\"walk.pc2\"\nframe_rate = 0"), Contains("frame_rate"));

  std::filesystem::remove(walk.path / "walk/body_0003.obj");
  CHECK_THAT(refused(pattern), Contains("body_0003.obj is missing") && Contains("1 to 5"));
  const TriangleMesh other = sphere(1, 0.3);
  write_obj(walk.path / "walk/body_0003.obj", other, other.positions);
  CHECK_THAT(refused(pattern), Contains("body_0003.obj: has 42 vertices") && Contains("body.obj has 8"));

  const std::string whole = content(walk.path / "walk.pc2");
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string changed = whole;
    walk.write("walk.pc2", changed.replace(at, bytes.size(), bytes));
    return refused(cache);
  };
  CHECK_THAT(with(0, "POINTCACHE3"), Contains("walk.pc2: is not a PC2 point cache"));
  CHECK_THAT(with(12, {"\2"}), Contains("version 2"));
  CHECK_THAT(with(16, {"\7"}), Contains("walk.pc2"));
  CHECK_THAT(with(28, {"\x09"}), Contains("cut short") && Contains("5 whole samples of the 9"));
  CHECK_THAT(with(28, {"\4"}), Contains("longer than the 4 samples"));
  CHECK_THAT(with(28, std::string(1, '\0')), Contains("0 samples"));
  CHECK_THAT(with(24, std::string(4, '\xff')), Contains("sample rate"));
  CHECK_THAT(with(32 + 12 * (2 * 8 + 3), std::string(4, '\xff')), Contains("point 3 of sample 2"));
  walk.write("walk.pc2", whole.substr(0, whole.size() - 1));
  CHECK_THAT(refused(cache), Contains("cut short") && Contains("4 whole samples of the 5"));
  walk.write("walk.pc2", whole.substr(0, 20));
  CHECK_THAT(refused(cache), Contains("is not a PC2 point cache"));
  Pc2Writer few(walk.path / "walk.pc2", 7);
  few.add(std::vector<Vec3>(7, Vec3::Zero()));
  few.close();
  few.keep();
  CHECK_THAT(refused(cache), Contains("has 7 points") && Contains("body.obj has 8 vertices"));
}

TEST_CASE("only a mesh has frames", "[moving]") {
  const Walk walk;
  walk.write("s.toml",
             "[[cloth]]\nmesh = \"sheet.obj\"\n[[obstacle]]\nshape = \"plane\"\nframes = \"walk.pc2\"\n");
  CHECK_THROWS_WITH(read_scene(walk.path / "s.toml", {}), Contains("s.toml:5") && Contains("frames"));
}

TEST_CASE("keys of frames without frames are refused", "[moving]") {
  const Walk walk;
  for (const char* key : {"frame_rate", "frames_start"})
    CHECK_THROWS_WITH(walk.body(key + std::string(" = 25\n")),
                      Contains(key) && Contains("belongs to `frames`"));
}

TEST_CASE("frames whose vertices are in another order or unit are refused by name", "[moving]") {
  const Walk walk;
  TriangleMesh fine = box_mesh({0.4, 0.2, 0.3});
  const auto write_frames = [&](const Places& second) {
    write_obj(walk.path / "f1.obj", fine, fine.positions);
    write_obj(walk.path / "f2.obj", fine, second);
  };
  const std::string keys = "frames = [\"f1.obj\", \"f2.obj\"]\n";
  Places larger = fine.positions;
  for (Vec3& x : larger) x *= 100;
  write_frames(larger);
  CHECK_THROWS_WITH(walk.body(keys), Contains("s.toml:") && Contains("frames: ") && Contains("f2.obj") &&
                                         Contains("100 times as long") && Contains("unit"));
  Places breath = fine.positions;
  for (Vec3& x : breath) x *= 1.2;
  write_frames(breath);
  CHECK_NOTHROW(walk.body(keys));
  // Of a longer mesh, the order of whose vertices is another one.
  fine = lat_long_sphere(20, 30, 0.2, Vec3::Zero());
  write_obj(walk.path / "body.obj", fine, fine.positions);
  Places shuffled = fine.positions;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  write_frames(shuffled);
  CHECK_THROWS_WITH(walk.body(keys), Contains("f2.obj") && Contains("another order"));
}

TEST_CASE("results do not replace the frames of a body", "[moving]") {
  const Walk walk;
  const auto refused = [&](const std::string& keys, Frames frames) {
    const Scene scene = read_scene(walk.scene(keys), {});
    const Simulation simulation = make_simulation(scene);
    CHECK_THROWS_WITH(Output(walk.path / "out", scene, simulation, frames), Contains("would be overwritten"));
  };
  std::filesystem::create_directories(walk.path / "out/frames");
  std::filesystem::copy(walk.path / "walk.pc2", walk.path / "out/sheet.pc2");
  refused("frames = \"out/sheet.pc2\"\n", Frames::pc2);
  std::filesystem::copy(walk.path / "walk/body_0001.obj", walk.path / "out/frames/sheet_0001.obj");
  refused("frames = \"out/frames/sheet_%04d.obj\"\n", Frames::obj);
  std::filesystem::copy(walk.path / "walk/body_0001.obj", walk.path / "out/sheet.obj");
  refused("frames = [\"out/sheet.obj\"]\n", Frames::none);
}
