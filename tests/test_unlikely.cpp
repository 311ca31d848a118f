// What a scene is told about quantities that are most often a mistake, and about keys that do nothing.
#include <algorithm>
#include <catch2/catch.hpp>

#include "mesh/obj/examine.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/garment.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

TEST_CASE("a quantity that is most often a mistake of its unit is told, and a usual one is not", "[scene]") {
  const Folder folder;
  folder.write("c.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0.1 0 0.1\nf 1 2 3\nf 2 4 3\n");
  const auto told = [&](const std::string& text, const std::string& what) {
    const std::string cloth = "[[cloth]]\nname = \"c\"\nmesh = \"c.obj\"\narea_density = \"0.2 kg/m^2\"\n";
    const Simulation made =
        make_simulation(read_scene(parse_toml(cloth + text, "s.toml"), {}, folder.path, "s.toml"));
    return std::any_of(made.messages.begin(), made.messages.end(),
                       [&](const std::string& m) { return m.find(what) != std::string::npos; });
  };
  struct Case {
    std::string usual, unlikely, what;
  };
  const std::string
      rope = "[[rope]]\nname = \"r\"\npoints = [[0, 1, 0], [1, 1, 0]]\nsegments = 4\nmass_per_length = ",
      plane = "[[obstacle]]\nshape = \"plane\"\nname = \"floor\"\npoint = [0, -1, 0]\nfriction = ",
      ball = "[[obstacle]]\nshape = \"sphere\"\nname = \"b\"\ncentre = [0, -50, 0]\nradius = ",
      moving = ball + "0.3\nmotion = { velocity = [0, 1, 0], start = ",
      led = "[[cloth.pins]]\nvertices = [1]\nmotion = { velocity = [0, 1, 0], start = ",
      second = "[[cloth]]\nname = \"d\"\nmesh = \"c.obj\"\ntranslate = [0, 1, 0]\narea_density = ";
  const std::vector<Case> cases = {
      {second + "\"200 g/m^2\"\n", second + "200\n", "cloth d: an area density of 200 kg/m^2"},
      {second + "\"20 g/m^2\"\n", second + "\"0.15 g/m^2\"\n", "cloth d: an area density of 0.15 g/m^2"},
      {"stretch = \"5 kN/m\"\n", "stretch = 1e12\n", "cloth c: a membrane stiffness of 1e+12 N/m"},
      {"bend = \"8 uN.m\"\n", "bend = 8\n", "cloth c: a bending rigidity of 8 N.m"},
      {"tear = \"40 %\"\n", "tear = 40\n", "was it meant in percent, \"40 %\"?"},
      {rope + "\"65 g/m\"\n", rope + "65\n", "rope r: a mass of 65 kg/m"},
      {plane + "0.5\n", plane + "50\n", "body floor: with a friction of 50 nothing slips"},
      {"self_contact = true\nfriction = 0.5\n", "self_contact = true\nfriction = 30\n",
       "cloth c: with a friction of 30 nothing slips"},
      {ball + "0.3\n", ball + "30\n", "body b: a radius of 30 m is"},
      {moving + "1 }\n", moving + "3 }\n", "body b: moves from 3 s on"},
      {led + "1 }\n", led + "3 }\n", "what is pinned at s.toml:"},
  };
  for (const Case& c : cases) {
    INFO(c.unlikely);
    CHECK(told(c.unlikely, c.what));
    CHECK_FALSE(told(c.usual, c.what.substr(0, 12)));
  }
}

TEST_CASE("vertices at one place that will be sewn together are no defect", "[scene]") {
  const TriangleMesh mesh = parse_obj(
      "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0.1 0 0\nv 0 0 0.1\nv 0.1 0 0.1\nf 1 2 3\nf 4 6 5\n", "c.obj");
  const auto coincide = [&](const std::vector<int>& sewn) {
    const std::vector<Defect> defects = examine(mesh, false, sewn).defects;
    return std::any_of(defects.begin(), defects.end(),
                       [](const Defect& d) { return d.what.find("coincide") != std::string::npos; });
  };
  CHECK(coincide({}));
  CHECK(coincide({1, 3}));
  CHECK_FALSE(coincide({1, 3, 2, 4}));
}

TEST_CASE("cloth far from the origin is told what its frames can tell", "[scene]") {
  const Folder folder;
  folder.write("c.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0.1 0 0.1\nf 1 2 3\nf 2 4 3\n");
  for (const auto& [x, far] : {std::pair{"100", false}, {"1e4", true}}) {
    INFO(x);
    const std::string text = std::string("[[cloth]]\nmesh = \"c.obj\"\ntranslate = [") + x + ", 0, 0]\n";
    const Names told =
        make_simulation(read_scene(parse_toml(text, "s.toml"), {}, folder.path, "s.toml")).messages;
    CHECK(far == std::any_of(told.begin(), told.end(), [](const std::string& m) {
            return m.find("from the origin") != std::string::npos;
          }));
  }
}

TEST_CASE("weld that finds nothing to join says so", "[scene]") {
  const Folder folder;
  const auto messages = [&](const std::string& second) {
    folder.write("c.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv " + second +
                              "\nv 0 0 0.1\nv 0.1 0 0.1\nf 1 2 3\nf 4 6 5\n");
    std::string all;
    const Scene scene = read_scene(parse_toml("[[cloth]]\nmesh = \"c.obj\"\nweld = true\n", "s.toml"), {},
                                   folder.path, "s.toml");
    for (const std::string& m : make_simulation(scene).messages) all += m + "\n";
    return all;
  };
  CHECK(messages("0.1 0 0").find("weld = true joins nothing") == std::string::npos);
  folder.write("c.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0.1 0 0.1\nf 1 2 3\nf 2 4 3\n");
  const Scene apart = read_scene(parse_toml("[[cloth]]\nmesh = \"c.obj\"\nweld = true\n", "s.toml"), {},
                                 folder.path, "s.toml");
  const Names told = make_simulation(apart).messages;
  CHECK(std::any_of(told.begin(), told.end(), [](const std::string& m) {
    return m.find("weld = true joins nothing") != std::string::npos;
  }));
}

TEST_CASE("a body whose frames jump, turn too far or turn it inside out is warned of, and no other",
          "[scene]") {
  const Folder folder;
  folder.write("c.obj", "v 0 3 0\nv 0.1 3 0\nv 0 3 0.1\nf 1 2 3\n");
  const TriangleMesh ball = sphere(1, 0.2);
  const auto frame = [&](const std::string& name, const Mat3& turn, const Vec3& way) {
    TriangleMesh moved = ball;
    for (Vec3& x : moved.positions) x = turn * x + way;
    write_obj(folder.path / name, moved, moved.positions);
  };
  frame("0.obj", Mat3::Identity(), Vec3::Zero());
  const auto warnings = [&](const Mat3& turn, const Vec3& way) {
    frame("1.obj", turn, way);
    const Simulation made = make_simulation(read_scene(
        parse_toml("[[cloth]]\nmesh = \"c.obj\"\narea_density = \"0.2 kg/m^2\"\n[[obstacle]]\nname = \"b\"\n"
                   "shape = \"mesh\"\nmesh = \"0.obj\"\nframes = [\"0.obj\", \"1.obj\"]\n",
                   "s.toml"),
        {}, folder.path, "s.toml"));
    std::string all;
    for (const std::string& message : made.messages)
      if (message.starts_with("warning: body b")) all += message + "\n";
    return all;
  };
  const auto turned_by = [](double angle) {
    return Mat3(Eigen::AngleAxisd(angle, Vec3(1, 2, 0).normalized()));
  };
  const Mat3 mirrored = Vec3(-1, 1, 1).asDiagonal();
  using Catch::Contains;
  CHECK_THAT(warnings(turned_by(0), {0.6, 0, 0}), Contains("jumps by 0.6 m, 0.87 times its size"));
  CHECK_THAT(warnings(turned_by(0), {0.6, 0, 0}), Contains("between its frames 1 and 2 (0 and 0.04 s)"));
  CHECK_THAT(warnings(turned_by(2.5), {0, 0, 0}), Contains("of its volume half-way"));
  CHECK_THAT(warnings(mirrored, {0, 0, 0}), Contains("is turned inside out"));
  CHECK(warnings(turned_by(1.3), {0.3, 0, 0}).empty());
  CHECK(warnings(0.5 * turned_by(0.5), {0, 0, 0}).empty());
}
