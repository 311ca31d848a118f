// Level sets in files: the round trip, other programs' grids, what is kept beside the mesh, what is refused,
// and the words of the command line.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "mesh/level_set/level_set.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

bool same_bits(const LevelSet& a, const LevelSet& b) {
  Random r;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x = r.point(i % 2 ? 0.35 : 0.8);
    const SurfacePoint p = a.closest(x), q = b.closest(x);
    if (p.distance != q.distance || p.normal != q.normal) return false;
  }
  return true;
}

// A sheet over a ball that is an OBJ file.
struct Room : Folder {
  Room() {
    TriangleMesh sheet = grid(9, 9, 0.6, 0.6);
    for (Vec3& x : sheet.positions) x[1] = 0.33;
    write_obj(path / "sheet.obj", sheet, sheet.positions);
    put_ball(0.3);
    write("s.toml", scene("mesh = \"ball.obj\"\nvoxel = \"2 cm\""));
  }
  void put_ball(double radius) const {
    const TriangleMesh ball = sphere(3, radius);
    write_obj(path / "ball.obj", ball, ball.positions);
  }
  static std::string scene(const std::string& keys) {
    return "[[cloth]]\nmesh = \"sheet.obj\"\n[simulation]\nduration = 0.1\n[[obstacle]]\nshape = "
           "\"level-set\"\n" +
           keys + "\n";
  }
  std::vector<fs::path> kept() const {
    std::vector<fs::path> all;
    for (const std::string& file : files())
      if (file.starts_with("ball.") && file.ends_with(".vdb")) all.push_back(path / file);
    return all;
  }
  std::string hash(const std::string& out) const {
    const std::string json = content(path / out / "run.json");
    const std::size_t at = json.find("state_hash");
    return json.substr(at, 34);
  }
};

}  // namespace

TEST_CASE("an open mesh is refused with the sizes of its holes", "[level-set]") {
  CHECK_THROWS_WITH(LevelSet::from_mesh(tube(24, 5, 0.1, 0.3), {}, "tube.obj"),
                    Contains("tube.obj: a level set needs a closed body") && Contains("2 holes") &&
                        Contains("24 edges, 0.627 m round, 0.283 m across, about (0, ") &&
                        Contains("0.15, 0)"));
  TriangleMesh one = sphere(2, 0.3);
  one.triangles.pop_back();
  CHECK_THROWS_WITH(LevelSet::from_mesh(one), Contains("has a hole: 3 edges"));
  CHECK_THROWS_WITH(LevelSet::from_mesh(sphere(2, 0.3), {.voxel = 1e-5}),
                    Contains("too large") && Contains("at least"));
  TriangleMesh fins = box_mesh(Vec3::Ones());  // three triangles at an edge
  fins.positions.push_back({1, 1, 1});
  fins.triangles.push_back({6, 7, 8});
  CHECK_THROWS_AS(LevelSet::from_mesh(fins), InputError);
}

#ifdef DRAPE_HAVE_OPENVDB

TEST_CASE("a .vdb file gives the same bits back, and scales", "[level-set]") {
  const Folder folder;
  const LevelSet made = LevelSet::from_mesh(sphere(3, 0.3), {.voxel = 0.02});
  folder.write("ball.vdb", made.vdb());
  const LevelSet read = LevelSet::read(folder.path / "ball.vdb");
  CHECK(same_bits(made, read));
  CHECK(read.voxel() == made.voxel());
  CHECK(read.band() == made.band());
  CHECK(read.voxels() == made.voxels());
  CHECK(read.error()->largest == made.error()->largest);
  const LevelSet twice = LevelSet::read(folder.path / "ball.vdb", 2);
  const Vec3 x(0.21, -0.2, 0.12);
  CHECK(twice.closest(2 * x).distance == Approx(2 * made.closest(x).distance));
  CHECK((twice.closest(2 * x).normal - made.closest(x).normal).norm() < 1e-6);
  CHECK(twice.error()->largest == 2 * made.error()->largest);
}

// Ours under another name is somebody else's: only the nodes near the surface are taken from it.
TEST_CASE("another program's level set is completed from its surface", "[level-set]") {
  const Folder folder;
  std::string bytes = LevelSet::from_mesh(sphere(4, 0.3), {.voxel = 0.02}).vdb();
  const std::size_t at = bytes.find("drape_format");
  REQUIRE(at != bytes.npos);
  bytes[at] = 'D';
  folder.write("other.vdb", bytes);
  const LevelSet other = LevelSet::read(folder.path / "other.vdb");
  CHECK(other.band() == Approx(0.06));
  CHECK_FALSE(other.error());
  CHECK((other.upper() - Vec3::Constant(0.3)).norm() < 0.01);
  Random r;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 x = r.point(0.8);
    const double d = x.norm() - 0.3, said = other.closest(x).distance;
    if (d < 0.06) CHECK(said == Approx(d).margin(d > -0.19 ? 0.005 : 0.1));
    if (d >= 0.06) CHECK(said <= d + 0.002);
    if (d < 0.06 && d > -0.19) CHECK((other.closest(x).normal - x.normalized()).norm() < 0.15);
  }
}

TEST_CASE("what is no level set is refused", "[level-set]") {
  const Folder folder;
  folder.write("text.vdb", "not a grid\n");
  folder.write("empty.vdb", "");
  const std::string good = LevelSet::from_mesh(sphere(2, 0.3)).vdb();
  folder.write("short.vdb", good.substr(0, good.size() / 2));
  std::string flipped = good;
  for (std::size_t at = good.size() / 3; at < good.size() - 64; at += 4096) flipped[at] ^= 0x55;
  folder.write("flipped.vdb", flipped);
  for (const char* name : {"none.vdb", "text.vdb", "empty.vdb", "short.vdb", "flipped.vdb"}) {
    INFO(name);
    CHECK_THROWS_AS(LevelSet::read(folder.path / name), InputError);
    CHECK_THROWS_WITH(LevelSet::read(folder.path / name), Contains(name));
  }
}

TEST_CASE("the level set is kept beside the mesh and used the next time", "[level-set][cli]") {
  const Room room;
  REQUIRE(room.drape("simulate s.toml --out one --quiet").exit_code == 0);
  REQUIRE(room.kept().size() == 1);
  const fs::path kept = room.kept().front();
  CHECK(kept.filename().string().size() == std::string("ball.0123456789abcdef.vdb").size());
  const auto written = fs::last_write_time(kept);
  REQUIRE(room.drape("simulate s.toml --out two --quiet").exit_code == 0);
  CHECK(fs::last_write_time(kept) == written);
  CHECK(room.hash("one") == room.hash("two"));

  SECTION("another mesh, voxel or scale makes another one; another place does not") {
    CHECK(room.drape("simulate s.toml --quiet --set obstacle.0.translate=[0,-0.01,0]").exit_code == 0);
    CHECK(room.kept().size() == 1);
    CHECK(room.drape("simulate s.toml --quiet --set obstacle.0.voxel=0.03").exit_code == 0);
    CHECK(room.drape("simulate s.toml --quiet --set obstacle.0.scale=0.9").exit_code == 0);
    room.put_ball(0.29);
    CHECK(room.drape("simulate s.toml --quiet").exit_code == 0);
    CHECK(room.kept().size() == 4);
  }
  SECTION("a damaged one is made anew") {
    const std::string good = content(kept);
    fs::resize_file(kept, 1000);
    const Outcome run = room.drape("simulate s.toml --out three");
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.err + run.out, Contains("is made anew"));
    CHECK(room.hash("three") == room.hash("one"));
    CHECK(content(kept).size() > good.size() / 2);
    CHECK_THAT(room.drape("simulate s.toml --out four").err, !Contains("is made anew"));
  }
  SECTION("where nothing can be kept it is made every time") {
    fs::remove(kept);
    fs::create_directory(kept);  // stands in the way, for root too
    room.write("in-the-way", "");
    const Outcome run = room.drape("simulate s.toml --out five");
    CHECK(run.exit_code == 0);
    CHECK(room.hash("five") == room.hash("one"));
  }
}

TEST_CASE("check keeps no level set", "[level-set][cli]") {
  const Room room;
  const Outcome check = room.drape("check s.toml");
  CHECK(check.exit_code == 0);
  CHECK_THAT(check.out, Contains("off by at most"));
  CHECK(room.kept().empty());
}

TEST_CASE("drape level-set makes a file that a scene can name", "[level-set][cli]") {
  const Room room;
  const Outcome made = room.drape("level-set ball.obj -o ball-grid.vdb --voxel '2 cm'");
  CHECK(made.exit_code == 0);
  CHECK_THAT(made.out, Contains("voxels of 20 mm") && Contains(" MB") && Contains("off by at most") &&
                           Contains("wrote ball-grid.vdb") && Contains(" s, "));
  room.write("v.toml", Room::scene("mesh = \"ball-grid.vdb\""));
  REQUIRE(room.drape("simulate v.toml --out grid --quiet").exit_code == 0);
  REQUIRE(room.drape("simulate s.toml --out mesh --quiet").exit_code == 0);
  CHECK(room.hash("grid") == room.hash("mesh"));
  const Outcome check = room.drape("check v.toml");
  CHECK_THAT(check.out, Contains("level-set") && Contains("voxels of 20 mm") && Contains("off by at most"));
  CHECK_THAT(room.drape("list").out, Contains("level-set"));

  const auto refused = [&](const std::string& words, const std::string& why) {
    const Outcome bad = room.drape(words);
    INFO(words);
    CHECK(bad.exit_code == 2);
    CHECK_THAT(bad.err, Contains(why));
    CHECK(std::count(bad.err.begin(), bad.err.end(), '\n') == 1);
  };
  refused("level-set sheet.obj -o a.vdb", "has a hole: 32 edges, 2.4 m round, 0.849 m across");
  refused("level-set ball.obj -o a.obj", "ends in .vdb");
  refused("level-set ball.obj -o a.vdb --voxel '3 kg'", "expected a length");
  refused("level-set none.obj -o a.vdb", "none.obj");
  refused("level-set ball.obj -o no/folder/a.vdb", "cannot write");
  refused("level-set sheet.obj -o no/folder/a.vdb", "cannot write");  // before anything is computed
  refused("level-set ball.obj -o a.vdb --voxel 1e-7", "ball.obj: a voxel of 1e-07 m makes too large a grid");
  const std::string to_a = "level-set ball.obj -o a.vdb ";
  refused(to_a + "--voxel 0", "--voxel 0: expected a length greater than zero");
  refused(to_a + "--voxel nan", "--voxel nan: is not a finite number");
  refused(to_a + "--scale 0", "--scale 0: expected a number greater than zero");
  refused(to_a + "--voxel 0.7", "ball.obj: a voxel of 0.7 m is too coarse for a body of 0.6 x 0.6 x 0.6 m");
  refused(to_a + "--voxel 1e400", "is not a finite number");
  for (const char* scale : {"1e30", "1e7", "1e-7", "1e-30", "1e-200"})
    refused(to_a + "--scale " + scale, "a level set is made of 1e-06 m to 1e+06 m: change the scale");
  CHECK_FALSE(fs::exists(room.path / "a.vdb"));
  const std::string before = content(room.path / "ball-grid.vdb");
  refused("level-set ball.obj -o ball-grid.vdb --voxel 0.7", "too coarse");
  CHECK(content(room.path / "ball-grid.vdb") == before);
  refused(to_a + "--scale 1e-5", "a .vdb file cannot hold a voxel of");
  CHECK(room.drape("level-set ball.obj -o small.vdb --scale 0.003 --voxel '15.1 um'").exit_code == 0);
  CHECK(room.drape("level-set ball.obj -o large.vdb --scale 1e6").exit_code == 0);
  room.write("c.toml", Room::scene("mesh = \"ball.obj\"\nvoxel = 0.7"));
  refused("simulate c.toml --out c", "a voxel of 0.7 m is too coarse");
  CHECK_FALSE(fs::exists(room.path / "c"));
  room.write("z.toml", Room::scene("mesh = \"ball-grid.vdb\"\nscale = 1e9"));
  refused("check z.toml", "change the scale");
  room.write("w.toml", Room::scene("mesh = \"ball-grid.vdb\"\nvoxel = 0.01"));
  refused("check w.toml", "w.toml:8: voxel");
  room.write("m.toml", Room::scene("mesh = \"ball-grid.vdb\"\nmargin = \"5 cm\""));
  refused("check m.toml", "margin of 50 mm is too wide");
  room.write("n.toml", Room::scene("mesh = \"none.vdb\""));
  refused("check n.toml", "no such file");
}

#endif
