// What a scene says of motion: bodies that are moved, bodies that move, pins that follow; and every mistake
// in it with its file and line.
#include <catch2/catch.hpp>
#include <numbers>
#include <string>

#include "app/base/toml_file.h"
#include "app/scene/scene.h"
#include "tests/folder.h"
#include "tests/mistakes.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

constexpr double pi = std::numbers::pi;

Scene read(const std::string& text, const std::filesystem::path& folder = "folder") {
  return read_scene(parse_toml(text, "scene.toml"), {}, folder, "scene.toml");
}

const std::string cloth = "[[cloth]]\nmesh = \"sheet.obj\"\n";  // two lines: the next one is line 3
// Ends in line 6 of the scene.
const std::string ball = cloth + "[[obstacle]]\nshape = \"sphere\"\nradius = 0.3\ncentre = [1, 2, 3]\n";

Motion motion_of(const std::string& line) { return read(ball + line + "\n").obstacles[0].obstacle.motion; }

double off(const Motion& motion, double time, const Vec3& X, const Vec3& x) {
  return (motion.at(time).to_world(X) - x).norm();
}

template <class Mistakes>
void check_scenes(const Mistakes& mistakes, const std::filesystem::path& folder = "folder") {
  check_mistakes(mistakes, [&](const std::string& text) { return read(text, folder); });
}

// Moments of what a shape encloses about its own axes through its centre,
// for a mass of 1, by cubes of side h.
Vec3 moments_by_cubes(const Shape& shape, const Vec3& centre, const Mat3& axes, double reach, double h) {
  double volume = 0;
  Vec3 squares = Vec3::Zero();
  for (double x = -reach + h / 2; x < reach; x += h)
    for (double y = -reach + h / 2; y < reach; y += h)
      for (double z = -reach + h / 2; z < reach; z += h) {
        if (closest(shape, centre + axes * Vec3(x, y, z)).distance > 0) continue;
        volume += 1;
        squares += Vec3(x * x, y * y, z * z);
      }
  return (Vec3::Constant(squares.sum()) - squares) / volume;
}

}  // namespace

TEST_CASE("a body without a motion stands", "[motion]") {
  const Scene scene = read(ball);
  CHECK_FALSE(scene.obstacles[0].obstacle.motion.moves());
  CHECK_FALSE(scene.obstacles[0].rigid);
}

TEST_CASE("a steady motion is read with its units", "[motion]") {
  const Motion motion = motion_of(
      "motion = { velocity = [\"20 cm/s\", 0, 0], spin = { axis = [0, 2, 0], rate = \"90 deg/s\" }, "
      "start = \"500 ms\", end = \"1.5 s\" }");
  CHECK(motion.moves());
  CHECK(motion.last_time() == 1.5);
  CHECK(off(motion, 0.5, Vec3(1, 2, 3), Vec3(1, 2, 3)) < 1e-14);
  CHECK(off(motion, 1.5, Vec3(1, 2, 3), Vec3(1.2, 2, 3)) < 1e-14);  // about the sphere's centre
  CHECK(off(motion, 9, Vec3(1, 2, 4), Vec3(2.2, 2, 3)) < 1e-14);
  const Motion rpm =
      motion_of("motion = { spin = { axis = [0, 1, 0], rate = \"30 rpm\" }, centre = [0, 0, 0] }");
  CHECK(off(rpm, 0.5, Vec3(0, 0, 1), Vec3(1, 0, 0)) < 1e-14);
  const Motion radians = motion_of("motion = { spin = { axis = [0, 1, 0], rate = -2 } }");
  CHECK(off(radians, pi / 4, Vec3(1, 2, 4), Vec3(0, 2, 3)) < 1e-14);
}

TEST_CASE("a body turns about its middle unless it says otherwise", "[motion]") {
  struct Row {
    std::string body;
    Vec3 middle;
  };
  const Row table[] = {
      {"shape = \"plane\"\npoint = [1, 2, 3]\n", {1, 2, 3}},
      {"shape = \"bowl\"\nradius = 1\ncentre = [1, 2, 3]\n", {1, 2, 3}},
      {"shape = \"box\"\nsize = [1, 1, 1]\ncentre = [1, 2, 3]\n", {1, 2, 3}},
      {"shape = \"capsule\"\na = [0, 0, 0]\nb = [2, 4, 6]\nradius = 1\n", {1, 2, 3}},
      {"shape = \"plate\"\nradius = 1\ncentre = [1, 2, 3]\n", {1, 2, 3}},
      {"shape = \"mesh\"\nmesh = \"body.obj\"\ntranslate = [1, 2, 3]\n", {1, 2, 3}},
      {"shape = \"sphere\"\nradius = 1\nmotion.centre = [4, 0, 0]\n", {4, 0, 0}},
  };
  for (const Row& row : table) {
    INFO(row.body);
    const Scene scene =
        read(cloth + "[[obstacle]]\n" + row.body + "motion.spin = { axis = [1, 1, 0], rate = 1 }\n");
    CHECK(off(scene.obstacles[0].obstacle.motion, 2, row.middle, row.middle) < 1e-14);
    CHECK(off(scene.obstacles[0].obstacle.motion, 2, Vec3(0, 0, 5), Vec3(0, 0, 5)) > 0.1);
  }
}

TEST_CASE("keyframes are read, and what one does not say stays", "[motion]") {
  const Motion motion = motion_of(R"(motion = { keyframes = [
  { time = "0 s" },
  { time = "1 s", translate = [0, "10 cm", 0], rotate = { axis = [0, 1, 0], angle = "720 deg" } },
  { time = "2 s", translate = [0, "30 cm", 0] },
  { time = "3 s", rotate = [{ axis = [0, 0, 1], angle = "90 deg" }, { axis = [1, 0, 0], angle = "90 deg" }] },
] })");
  CHECK(motion.last_time() == 3);
  CHECK(off(motion, 0, Vec3(1, 2, 4), Vec3(1, 2, 4)) < 1e-14);
  // One turn, slopes 0 and 0.4/3 m/s.
  CHECK(off(motion, 0.5, Vec3(1, 2, 4), Vec3(1, 2 + 0.1 / 3, 4)) < 1e-14);
  CHECK(off(motion, 1, Vec3(1, 2, 4), Vec3(1, 2.1, 4)) < 1e-14);
  CHECK(off(motion, 2, Vec3(1, 2, 4), Vec3(1, 2.3, 4)) < 1e-14);
  CHECK(off(motion, 3, Vec3(2, 2, 3), Vec3(1, 2.3, 4)) < 1e-14);  // x -> y -> z
  double turned = 0;
  for (int k = 0; k < 1000; ++k) {
    const Mat3 step = motion.at(k * 1e-3).rotation.transpose() * motion.at((k + 1) * 1e-3).rotation;
    turned += Eigen::AngleAxisd(step).angle();
  }
  CHECK(turned == Approx(4 * pi));
}

TEST_CASE("poses are read from a CSV file beside the scene", "[motion]") {
  const Folder folder;
  folder.write("poses.csv",
               "\xEF\xBB\xBF# from the tracker\r\n\"time [ms]\", x [mm],y [mm],z [mm],qw,qx,qy,qz\r\n"
               "0,0,0,0,1,0,0,0\r\n\r\n1000,100,0,0,0.7071,0,0.7071,0\r\n2000,+1e2,0,0,-1,0,0,0\r\n");
  const Scene scene = read(ball + "motion = { poses = \"poses.csv\", centre = [0, 0, 0] }\n", folder.path);
  const Motion& motion = scene.obstacles[0].obstacle.motion;
  CHECK(motion.last_time() == 2);
  CHECK(off(motion, 1, Vec3(0, 0, 1), Vec3(1.1, 0, 0)) < 1e-14);
  CHECK(off(motion, 2, Vec3(0, 0, 1), Vec3(0.1, 0, 1)) < 1e-14);  // -q is q
  CHECK(off(motion, 0.5, Vec3(0, 0, 1), Vec3(std::sqrt(0.5) + 0.05, 0, std::sqrt(0.5))) < 0.1);
}

TEST_CASE("a mistake in a motion is told with its line", "[motion]") {
  const std::pair<const char*, const char*> motions[] = {
      {R"(3)", "expected a table with one of velocity and spin"},
      {R"({})", "expected one of velocity and spin"},
      {R"({ velocty = [1, 0, 0] })", "did you mean 'velocity'?"},
      {R"({ velocity = [1, 0, 0], poses = "a.csv" })", "expected one of"},
      {R"({ keyframes = [], poses = "a.csv" })", "expected one of"},
      {R"({ keyframes = [], start = 1 })", "expected one of"},
      {R"({ start = 1 })", "neither velocity nor spin"},
      {R"({ velocity = ["1 m", 0, 0] })", "expected a speed"},
      {R"({ velocity = [1, 0, 0], end = 0 })", "must come after the start, 0 s"},
      {R"({ velocity = [1, 0, 0], start = "2 s", end = "1 s" })", "the start, 2 s"},
      {R"({ velocity = [1, 0, 0], centre = [0, 0, "1 s"] })", "expected a length"},
      {R"({ spin = 3 })", "expected { axis"},
      {R"({ spin = { axis = [0, 1, 0] } })", "'rate' is missing"},
      {R"({ spin = { rate = 3 } })", "'axis' is missing"},
      {R"({ spin = { axis = [0, 0, 0], rate = 3 } })", "an axis that has a length"},
      {R"({ spin = { axis = [0, 1, 0], rate = "3 deg" } })", "a rate of turning"},
      {R"({ spin = { axis = [0, 1, 0], rate = "3 Hz" } })", "names no angle"},
      {R"({ poses = "" })", "the name of a CSV file"},
      {R"({ poses = "none.csv" })", "folder/none.csv: no such file"},
      {R"({ keyframes = [] })", "at least one"},
      {R"({ keyframes = [1] })", "expected tables"},
  };
  std::vector<Mistake> table;
  for (const auto& [motion, message] : motions)
    table.push_back({ball + "motion = " + motion + "\n", "scene.toml:7:", message});
  check_scenes(table);
}

TEST_CASE("a mistake in a keyframe is told with its line", "[motion]") {
  const std::string keys = ball + "motion = { keyframes = [\n";  // line 7; the first keyframe is line 8
  const Mistake table[] = {
      {keys + "{ translate = [0, 0, 0] },\n] }\n", "scene.toml:8:", "'time' is missing"},
      {keys + "{ time = 0 },\n{ time = 1, move = 1 },\n] }\n", "scene.toml:9:", "unknown key 'move'"},
      {keys + "{ time = 0 },\n{ time = \"1 m\" },\n] }\n", "scene.toml:9:", "expected a time"},
      {keys + "{ time = 0 },\n{ time = 1, rotate = { axis = [0, 1, 0] } },\n] }\n",
       "scene.toml:9:", "'angle' is missing"},
      {keys + "{ time = 0 },\n{ time = \"2 s\" },\n{ time = \"1 s\" },\n] }\n",
       "scene.toml:10:", "time = \"1 s\": keyframes out of order: 1 s comes after 2 s"},
      {keys + "{ time = 0 },\n{ time = 0.0 },\n] }\n",
       "scene.toml:9:", "keyframes out of order: 0 s comes after 0 s"},
  };
  check_scenes(table);
}

TEST_CASE("a mistake in a file of poses names that file", "[motion]") {
  const Folder folder;
  folder.write("poses.csv", "time,x,y,z\n1,0,0,0\n0,0,0,0\n");
  folder.write("empty.csv", "");
  const auto line = [&](const char* file) { return ball + "motion = { poses = \"" + file + "\" }\n"; };
  const Mistake table[] = {
      {line("poses.csv"), (folder.path / "poses.csv").string() + ":3:", "out of order"},
      {line("empty.csv"), (folder.path / "empty.csv").string() + ":", "the file is empty"},
      {line("."), folder.path.string(), "is a directory"},
  };
  check_scenes(table, folder.path);
}

TEST_CASE("a body with a mass has a first velocity, a spin and moments", "[motion]") {
  const ObstacleEntry entry = read(ball +
                                   "mass = \"500 g\"\nvelocity = [0, \"10 cm/s\", 0]\nspin = { axis = [0, 0, "
                                   "2], rate = \"60 rpm\" }\n")
                                  .obstacles[0];
  REQUIRE(entry.rigid);
  CHECK(entry.rigid->mass == 0.5);
  CHECK((entry.rigid->velocity - Vec3(0, 0.1, 0)).norm() < 1e-15);
  CHECK((entry.rigid->spin - Vec3(0, 0, 2 * pi)).norm() < 1e-14);
  CHECK_FALSE(entry.obstacle.motion.moves());
  const ObstacleEntry given = read(ball + "mass = 2\ninertia = [1, \"2e4 g.m^2\", 20]\n").obstacles[0];
  REQUIRE(given.rigid->inertia);
  CHECK((*given.rigid->inertia - Vec3(1, 20, 20)).norm() < 1e-12);
  const std::string mesh = cloth + "[[obstacle]]\nshape = \"mesh\"\nmesh = \"body.obj\"\nmass = 1\n";
  CHECK_FALSE(read(mesh).obstacles[0].rigid->inertia);
}

TEST_CASE("the moments of a solid are those of its inside", "[motion]") {
  const std::string bodies[] = {
      "shape = \"sphere\"\nradius = 0.9\n",
      "shape = \"box\"\nsize = [0.4, 1.6, 0.8]\nrotate = { axis = [1, 2, 3], angle = 1 }\n",
      "shape = \"capsule\"\na = [-0.3, -0.2, -0.1]\nb = [0.3, 0.2, 0.1]\nradius = 0.4\n",
      "shape = \"capsule\"\na = [0.5, 0, 0]\nb = [-0.5, 0, 0]\nradius = 0.2\n",
      "shape = \"capsule\"\na = [0, 0, 0]\nb = [0, 0, 0]\nradius = 0.5\n",
      "shape = \"plate\"\nradius = 0.8\nheight = 0.5\nrim = 0.2\naxis = [1, 2, 3]\n",
  };
  for (const std::string& body : bodies) {
    INFO(body);
    const ObstacleEntry entry = read(cloth + "[[obstacle]]\n" + body + "mass = 3\n").obstacles[0];
    REQUIRE(entry.rigid);
    CHECK_FALSE(entry.rigid->inertia);
    const Mat3& axes = entry.rigid->axes;
    CHECK((axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
    const Vec3 counted = 3 * moments_by_cubes(entry.obstacle.shape, Vec3::Zero(), axes, 1, 0.025);
    const Mat3 own = axes.transpose() * uniform_solid(entry.obstacle.shape, 3)->inertia * axes;
    CHECK((own - Mat3(counted.asDiagonal())).cwiseAbs().maxCoeff() < 0.02 * counted.maxCoeff());
  }
}

TEST_CASE("a mistake in a body with a mass is told with its line", "[motion]") {
  const Mistake table[] = {
      {ball + "mass = 0\n", "scene.toml:7:", "greater than zero"},
      {ball + "mass = \"3 m\"\n", "scene.toml:7:", "expected a mass"},
      {ball + "velocity = [1, 0, 0]\n", "scene.toml:7:", "needs a mass"},
      {ball + "spin = { axis = [0, 1, 0], rate = 1 }\n", "scene.toml:7:", "needs a mass"},
      {ball + "inertia = [1, 1, 1]\n", "scene.toml:7:", "needs a mass"},
      {ball + "mass = 1\nmotion = { velocity = [1, 0, 0] }\n", "scene.toml:8:", "leave the mass out"},
      {ball + "mass = 1\ninertia = [1, 0, 1]\n", "scene.toml:8:", "greater than zero"},
      {ball + "mass = 1\ninertia = [1, 1, 3]\n", "scene.toml:8:", "the sum of the other two"},
      {ball + "mass = 1\ninertia = [1, 1]\n", "scene.toml:8:", "list of three"},
      {cloth + "[[obstacle]]\nshape = \"plane\"\nmass = 1\n", "scene.toml:5:", "a plane cannot move"},
      {cloth + "[[obstacle]]\nshape = \"bowl\"\nradius = 1\nmass = 1\n",
       "scene.toml:6:", "a bowl cannot move"},
  };
  check_scenes(table);
}

TEST_CASE("pins follow a body or a path", "[motion]") {
  const std::string body = "[[obstacle]]\nshape = \"sphere\"\nradius = 1\nname = \"body\"\n";
  const Scene scene =
      read(cloth +
           "pins = [ { group = \"waist\", follow = \"body\" }, { vertices = [3], motion = { keyframes = "
           "[{ time = 0 }, { time = 1, rotate = { axis = [0, 1, 0], angle = \"90 deg\" } }] } }, "
           "{ vertices = [4] } ]\n" +
           body);
  const std::vector<PinEntry>& pins = scene.cloths[0].pins;
  REQUIRE(pins.size() == 3);
  CHECK(pins[0].follow == "body");
  CHECK_FALSE(pins[0].motion);
  REQUIRE(pins[1].motion);
  CHECK(pins[1].follow.empty());
  CHECK(off(*pins[1].motion, 1, Vec3(0, 0, 1), Vec3(1, 0, 0)) < 1e-14);  // about the origin
  CHECK(pins[2].follow.empty());
  CHECK_FALSE(pins[2].motion);
  CHECK(read(cloth + "pins = []\n").cloths[0].pins.empty());
  CHECK_NOTHROW(read(cloth + "pins = [{ vertices = [1] }]\n" + body + body));  // nothing refers to the name
}

TEST_CASE("a mistake in a pin that moves is told with its line", "[motion]") {
  const std::string body = "[[obstacle]]\nshape = \"sphere\"\nradius = 1\nname = \"body\"\n";
  const std::string other = "[[obstacle]]\nshape = \"sphere\"\nradius = 1\nname = \"stool\"\n";
  const std::string pin = cloth + "pins = [\n{ vertices = [1], ";  // line 4
  const Mistake table[] = {
      {cloth + "pins = [{}]\n", "scene.toml:3:", "expected one of vertices"},
      {cloth + "pins = [{ follow = \"body\" }]\n" + body, "scene.toml:3:", "expected one of vertices"},
      {pin + "folow = \"body\" }]\n" + body, "scene.toml:4:", "did you mean 'follow'?"},
      {pin + "follow = 3 }]\n" + body, "scene.toml:4:", "expected a text"},
      {pin + "follow = \"\" }]\n" + body, "scene.toml:4:", "the name of an obstacle"},
      {pin + "follow = \"boddy\" }]\n" + body + other, "scene.toml:4:",
       "follow = \"boddy\": there is no obstacle of that name; did you mean 'body'? known are: body, stool"},
      {pin + "follow = \"body\" }]\n", "scene.toml:4:", "known are: (none)"},
      {pin + "follow = \"body\" }]\n" + body + body, "scene.toml:4:", "there are 2 obstacles of that name"},
      {pin + "follow = \"body\", motion = { velocity = [1, 0, 0] } }]\n" + body, "scene.toml:4:", "not both"},
      {pin + "motion = { velocity = [1, 0] } }]\n", "scene.toml:4:", "list of three"},
      {pin + "motion = { keyframes = [{ time = 1 },\n{ time = 0.5 }] } }]\n",
       "scene.toml:5:", "out of order"},
  };
  check_scenes(table);
}
