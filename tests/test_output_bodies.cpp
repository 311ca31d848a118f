// Bodies in the output folder: where they are, how they look, what their files are called.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "app/recording/body_files.h"
#include "mesh/obj/examine.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr double pi = std::numbers::pi;
using Files = std::set<std::string>;

// A small sheet far above bodies of every kind: it touches none.
struct Stage : Folder {
  Stage() {
    TriangleMesh sheet = grid(3, 3, 0.2, 0.2);
    for (Vec3& x : sheet.positions) x[1] = 9;
    write_obj(path / "sheet.obj", sheet, sheet.positions);
    write("cube.obj", cube);
    write("poses.csv", "time,x,y,z\n0,0,0,0\n1,0,0.5,0\n");
    write("s.toml", simulation + cloth + spinning_cube + ball + second_ball + floor + table);
  }

  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::string simulation = "[simulation]\nduration = 1.2\nframe_rate = 10\n";
  const std::string cloth = "[[cloth]]\nmesh = \"sheet.obj\"\nfabric = \"cotton-poplin\"\n";
  const std::string spinning_cube =
      "[[obstacle]]\nshape = \"mesh\"\nmesh = \"cube.obj\"\ntranslate = [3, 0, 0]\n"
      "motion = { spin = { axis = [0, 0, 1], rate = \"1 turn/s\" } }\n";
  const std::string ball =
      "[[obstacle]]\nshape = \"sphere\"\nname = \"sheet\"\nradius = 0.1\ncentre = [-3, 2, 0]\n"
      "mass = \"2 kg\"\nvelocity = [1, 0, 0]\n";
  const std::string second_ball = "[[obstacle]]\nshape = \"sphere\"\nradius = 0.1\ncentre = [-6, 2, 0]\n";
  const std::string floor =
      "[[obstacle]]\nshape = \"plane\"\npoint = [0, -20, 0]\nmotion = { velocity = [0, 0.5, 0] }\n";
  const std::string table =
      "[[obstacle]]\nshape = \"box\"\nname = \"a table/top\"\nsize = [1, 2, 3]\ncentre = [9, 0, 0]\n";
};

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  double off = 0;
  for (std::size_t i = 0; i < a.size(); ++i) off = std::max(off, (a[i] - b[i]).norm());
  return off;
}

Pose pose_of(const std::vector<std::string>& row) {
  const auto number = [&](std::size_t k) { return std::stod(row[k]); };
  return {Eigen::Quaterniond(number(6), number(7), number(8), number(9)).toRotationMatrix(),
          {number(3), number(4), number(5)}};
}

// The rows of bodies.csv of one body.
std::vector<std::vector<std::string>> rows_of(const std::string& text, const std::string& body) {
  std::istringstream lines(text);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);)
    if (cells(line)[2] == body) rows.push_back(cells(line));
  return rows;
}

// Where the cube is after `time`: turned about the place it was moved to.
std::vector<Vec3> turned_cube(const TriangleMesh& cube, double time) {
  const Eigen::AngleAxisd turn(2 * pi * time, Vec3::UnitZ());
  std::vector<Vec3> positions = cube.positions;
  for (Vec3& x : positions) x = turn * x + Vec3(3, 0, 0);
  return positions;
}

}  // namespace

TEST_CASE("built-in bodies are drawn where their surface is", "[output]") {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const std::vector<Shape> shapes = {Sphere{{1, 2, 3}, 0.3},
                                     Box{{1, 2, 3}, {0.5, 1, 2}, turn},
                                     Capsule{{1, 0, 0}, {0, 0.3, 1}, 0.2},
                                     Capsule{{1, 0, 0}, {1, 0, 0}, 0.2},
                                     Bowl{{1, 2, 3}, 0.4, 0.02, {1, -2, 0.5}},
                                     Bowl{{0, 0, 0}, 0.4, 0.1, {0, -1, 0}},
                                     Plate{{1, 2, 3}, 0.09, 0.02, 0.005, {1, -2, 0.5}},
                                     Plate{{0, 0, 0}, 0.2, 0.4, 0.2},
                                     Plate{{0, 0, 0}, 0.2, 0.5, 0.2},
                                     Plate{{0, 0, 0}, 0.2, 0.1, 0.05},
                                     Plate{{0, 0, 0}, 0.2, 0.1, 0}};
  for (const Shape& shape : shapes) {
    INFO(name(shape));
    const TriangleMesh mesh = mesh_of(shape);
    CHECK(examine(mesh).closed);
    CHECK(examine(mesh).defects.empty());
    for (const Vec3& x : mesh.positions) CHECK(std::abs(closest(shape, x).distance) < 1e-12);
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const SurfacePoint middle = closest(shape, (a + b + c) / 3);
      CHECK(std::abs(middle.distance) < 1e-3);  // looks round
      CHECK((b - a).cross(c - a).normalized().dot(middle.normal) > 0.9);
    }
  }
  CHECK(mesh_of(Plane()).positions.empty());
}

TEST_CASE("bodies have files of their own names as far as these can be", "[output]") {
  CHECK(body_file_names({"sphere", "sphere", "body.obj", "a/b c", "sphere_2", "", ".x", "ball", "größe"},
                        {"ball"}) ==
        Names{"sphere", "sphere_2", "body", "a_b_c", "sphere_2_2", "body_2", "_x", "ball_2", "größe"});
}

TEST_CASE("the last shape of every body is written with its own faces", "[output]") {
  const Stage stage;
  const Outcome run = stage.drape("simulate s.toml --out o");
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("wrote o/bodies (4 shapes)") && Contains("wrote o/bodies.csv (13 frames)"));
  CHECK(stage.files("o/bodies") == Files{"cube.obj", "sheet_2.obj", "sphere.obj", "a_table_top.obj"});

  const TriangleMesh cube = read_obj(stage.path / "o/bodies/cube.obj");
  CHECK_THAT(content(stage.path / "o/bodies/cube.obj"), Contains("f 4 3 2 1") && Contains("f 4 1 5 8"));
  CHECK(farthest(cube.positions, turned_cube(read_obj(stage.path / "cube.obj"), 1.2)) < 1e-12);

  Vec3 middle = Vec3::Zero();
  const TriangleMesh ball = read_obj(stage.path / "o/bodies/sheet_2.obj");
  for (const Vec3& x : ball.positions) middle += x / ball.vertex_count();
  const double fallen = 9.81 * 0.01 * 0.01 * 120 * 121 / 2;  // v, then x, each step
  CHECK((middle - Vec3(-1.8, 2 - fallen, 0)).norm() < 1e-9);
  CHECK(read_obj(stage.path / "o/bodies/a_table_top.obj").vertex_count() == 8);
}

TEST_CASE("bodies.csv has a pose for each frame of what moves", "[output]") {
  const Stage stage;
  REQUIRE(stage.drape("simulate s.toml --out o --quiet").exit_code == 0);
  const std::string csv = content(stage.path / "o/bodies.csv");
  CHECK_THAT(csv, Catch::StartsWith("frame,time,body,x,y,z,qw,qx,qy,qz\n"));
  CHECK(count(csv, "\n") == 1 + 13 * 3);  // the cube, the ball with a mass, the floor
  const TriangleMesh start = read_obj(stage.path / "cube.obj");
  const auto rows = rows_of(csv, "cube");
  REQUIRE(rows.size() == 13);
  double last_qw = 1, last_qz = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    INFO("frame " << k + 1);
    CHECK(rows[k][0] == std::to_string(k + 1));
    CHECK(std::stod(rows[k][1]) == Approx(0.1 * static_cast<double>(k)));
    std::vector<Vec3> positions = turned_cube(start, 0);
    for (Vec3& x : positions) x = pose_of(rows[k]).to_world(x);
    CHECK(farthest(positions, turned_cube(start, 0.1 * static_cast<double>(k))) < 1e-8);
    const double qw = std::stod(rows[k][6]), qz = std::stod(rows[k][9]);
    CHECK(qw * last_qw + qz * last_qz > 0.9);  // through more than a whole turn without a jump
    last_qw = qw, last_qz = qz;
  }
  CHECK(last_qw < 0);
  CHECK((pose_of(rows_of(csv, "plane").back()).translation - Vec3(0, 0.6, 0)).norm() < 1e-9);
  CHECK(std::stod(rows_of(csv, "sheet_2").back()[3]) == Approx(1.2));
}

TEST_CASE("frames as OBJ files hold the bodies that move", "[output]") {
  const Stage stage;
  REQUIRE(stage.drape("simulate s.toml --out o --quiet --frames obj --duration 0.2").exit_code == 0);
  CHECK(stage.files("o/frames") == Files{"sheet_0001.obj", "sheet_0002.obj", "sheet_0003.obj",
                                         "sheet_2_0001.obj", "sheet_2_0002.obj", "sheet_2_0003.obj",
                                         "cube_0001.obj", "cube_0002.obj", "cube_0003.obj"});
  CHECK(farthest(read_obj(stage.path / "o/frames/cube_0002.obj").positions,
                 turned_cube(read_obj(stage.path / "cube.obj"), 0.1)) < 1e-12);
  CHECK(read_obj(stage.path / "o/frames/sheet_0001.obj").vertex_count() == 9);
  CHECK(content(stage.path / "o/frames/cube_0003.obj") == content(stage.path / "o/bodies/cube.obj"));

  REQUIRE(stage.drape("simulate s.toml --out n --quiet --frames none --duration 0.2").exit_code == 0);
  CHECK(stage.files("n") == Files{"bodies", "run.json", "sheet.obj", "steps.csv"});
  CHECK(content(stage.path / "n/bodies/cube.obj") == content(stage.path / "o/bodies/cube.obj"));
}

TEST_CASE("a body that deforms is written as it is then", "[output]") {
  const Stage stage;
  TriangleMesh cube = read_obj(stage.path / "cube.obj");
  std::vector<Vec3> end = cube.positions;
  for (std::size_t i = 0; i < end.size(); ++i) end[i][1] += 0.5 * static_cast<double>(i % 3);
  write_obj(stage.path / "walk_0001.obj", cube, cube.positions);
  write_obj(stage.path / "walk_0002.obj", cube, end);
  stage.write("d.toml",
              stage.simulation + stage.cloth +
                  "[[obstacle]]\nshape = \"mesh\"\nmesh = \"cube.obj\"\nframes = \"walk_%04d.obj\"\n"
                  "frame_rate = \"5 Hz\"\n");
  REQUIRE(stage.drape("simulate d.toml --out o --quiet --frames obj --duration 0.3").exit_code == 0);
  CHECK(farthest(read_obj(stage.path / "o/bodies/cube.obj").positions, end) < 1e-6);  // frames are float
  std::vector<Vec3> half = cube.positions;
  for (std::size_t i = 0; i < half.size(); ++i) half[i] = (half[i] + end[i]) / 2;
  CHECK(farthest(read_obj(stage.path / "o/frames/cube_0002.obj").positions, half) < 1e-6);
  CHECK(stage.files("o") == Files{"bodies", "fields", "frames", "run.json", "sheet.obj", "steps.csv"});
  CHECK(JsonValue::parse(content(stage.path / "o/run.json"))["bodies"][0]["deforms"] == true);
}

TEST_CASE("run.json says how bodies ended", "[output]") {
  const Stage stage;
  REQUIRE(stage.drape("simulate s.toml --out o --quiet").exit_code == 0);
  JsonValue bodies = JsonValue::parse(content(stage.path / "o/run.json"))["bodies"];
  REQUIRE(bodies.size() == 5);
  for (JsonValue& body : bodies) {  // places are followed in test_recording.cpp
    double squared = 0;
    for (const JsonValue& part : body["place"]["rotation"]) squared += std::pow(part.get<double>(), 2);
    CHECK(squared == Approx(1));
    CHECK(body["place"]["translation"].size() == 3);
    body.erase("place");
    for (const char* key : {"friction", "margin", "restitution"}) CHECK(body.erase(key) == 1);
  }
  CHECK(bodies[0] == JsonValue{{"name", "cube.obj"},
                               {"file", "bodies/cube.obj"},
                               {"shape", "mesh"},
                               {"moves", true},
                               {"deforms", false},
                               {"reacts", false}});
  CHECK(bodies[3]["file"].is_null());
  CHECK(bodies[4]["name"] == "a table/top");
  CHECK(bodies[4]["moves"] == false);
  const JsonValue& ball = bodies[1];
  CHECK(ball["reacts"] == true);
  CHECK(ball["mass"] == 2);
  CHECK(ball["velocity"][0].get<double>() == Approx(1));
  CHECK(ball["velocity"][1].get<double>() == Approx(-9.81 * 1.2));
  CHECK(ball["momentum"][1].get<double>() == Approx(-2 * 9.81 * 1.2));
  CHECK(ball["position"][0].get<double>() == Approx(-1.8));
}

TEST_CASE("bodies that stand still need no file of poses", "[output]") {
  const Stage stage;
  stage.write("still.toml", stage.simulation + stage.cloth + stage.second_ball);
  REQUIRE(stage.drape("simulate still.toml --out o --quiet --frames obj --duration 0.1").exit_code == 0);
  CHECK(stage.files("o") == Files{"bodies", "fields", "frames", "run.json", "sheet.obj", "steps.csv"});
  CHECK(stage.files("o/frames") == Files{"sheet_0001.obj", "sheet_0002.obj"});
  stage.write("none.toml", stage.simulation + stage.cloth);
  REQUIRE(stage.drape("simulate none.toml --out n --quiet --duration 0.1").exit_code == 0);
  CHECK(stage.files("n") == Files{"fields", "run.json", "sheet.obj", "sheet.pc2", "steps.csv"});
}

TEST_CASE("results never replace what the scene is made from", "[output]") {
  const Stage stage;
  for (const char* folder : {"o/bodies", "o/frames"}) fs::create_directories(stage.path / folder);
  const auto refused = [&](const std::string& input, const std::string& text, const std::string& words) {
    INFO(input);
    const std::string obstacle = "[[obstacle]]\n" + text;
    stage.write(input, input.ends_with(".csv") ? content(stage.path / "poses.csv") : stage.cube);
    const std::string before = content(stage.path / input);
    stage.write("r.toml", stage.simulation + stage.cloth + obstacle);
    const Outcome run = stage.drape("simulate r.toml --out o --duration 0.1 " + words);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Contains(input + ": ") && Contains("would be overwritten"));
    CHECK(content(stage.path / input) == before);
    fs::remove(stage.path / input);
    CHECK(stage.files("o") == Files{"bodies", "frames"});
  };
  const std::string mesh = "shape = \"mesh\"\nmesh = ", moved = "motion = { velocity = [1, 0, 0] }\n";
  refused("o/bodies/cube.obj", mesh + "\"o/bodies/cube.obj\"\n", "");
  refused("o/frames/cube_0100.obj", mesh + "\"o/frames/cube_0100.obj\"\nname = \"cube\"\n" + moved,
          "--frames obj");
  for (const char* name : {"o/bodies.csv", "o/steps.csv"})
    refused(name, "shape = \"sphere\"\nradius = 1\nmotion = { poses = \"" + std::string(name) + "\" }\n", "");
  stage.write("o/poses.csv", content(stage.path / "poses.csv"));
  stage.write("p.toml", stage.simulation + stage.cloth +
                            "pins = [{ vertices = [0], motion = { poses = \"o/poses.csv\" } }]\n");
  CHECK(stage.drape("simulate p.toml --out o --quiet --duration 0.1").exit_code == 0);
  fs::rename(stage.path / "o/poses.csv", stage.path / "o/steps.csv");
  stage.write("p.toml", stage.simulation + stage.cloth +
                            "pins = [{ vertices = [0], motion = { poses = \"o/steps.csv\" } }]\n");
  CHECK(stage.drape("simulate p.toml --out o --quiet --duration 0.1").exit_code == 2);
}
