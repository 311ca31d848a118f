// The program as people run it: what it writes and says. test_cli_refusals.cpp has what goes wrong.
#include <filesystem>
#include <numeric>

#include "solver/integrators/integrator.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

TEST_CASE("a scene is simulated and everything is written", "[cli]") {
  const Workshop shop;
  const Outcome run = shop.drape("simulate s.toml --out o");
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("wrote o/sheet.obj") && Contains("wrote o/run.json"));
  CHECK_THAT(run.err, Contains(" 50 %"));
  CHECK(shop.files("o") == usual_files);

  const Json json = shop.json("o/run.json");
  for (const char* key : {"drape_version",   "scene",
                          "cloths",          "integrator",
                          "contact",         "linear_solver",
                          "threads",         "time_step",
                          "steps",           "simulated_seconds",
                          "wall_seconds",    "ms_per_step",
                          "phases_ms",       "linear_iterations",
                          "state",           "max_speed",
                          "max_edge_strain", "max_penetration",
                          "state_hash",      "warnings"}) {
    INFO(key);
    CHECK(json.contains(key));
  }
  CHECK(json["scene"] == "s.toml");
  CHECK(json["steps"] == 30);
  CHECK(json["simulated_seconds"].get<double>() == Approx(0.3));
  CHECK(json["cloths"][0]["name"] == "sheet");
  CHECK(json["cloths"][0]["particles"] == 169);
  CHECK(json["cloths"][0]["triangles"] == 288);
  CHECK(json["cloths"][0]["edges"] == 456);
  for (const char* key : {"median", "p95", "max"}) CHECK(json["ms_per_step"][key].is_number());
  for (const char* key : {"assemble", "solve", "collide", "write"}) CHECK(json["phases_ms"][key].is_number());
  for (const char* key : {"mean", "max"}) CHECK(json["linear_iterations"][key].is_number());
  CHECK(json["state_hash"].get<std::string>().size() == 16);

  CHECK(lines_of(content(shop.path / "o/steps.csv")) == 31);
  CHECK(fs::file_size(shop.path / "o/sheet.pc2") == 32 + 9 * 169 * 12);  // 0, 0.04 ... 0.28 s
  CHECK(read_obj(shop.path / "o/sheet.obj").vertex_count() == 169);
}

namespace {

// The numbers of one column of a CSV file; empty when there is no such column.
std::vector<double> column(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::vector<double> values;
  long wanted = -1;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    long k = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++k)
      if (values.empty() && cell == name)
        wanted = k;
      else if (k == wanted)
        values.push_back(std::stod(cell));
  }
  return values;
}

}  // namespace

TEST_CASE("inner steps are in steps.csv and run.json", "[cli]") {
  const Workshop shop;
  double in_vain = 0;
  for (const IntegratorInfo& integrator : integrators()) {
    const bool adaptive = integrator.name.starts_with("cvode-") || integrator.name.starts_with("arkode-");
    if (!adaptive && integrator.name != "implicit-euler") continue;
    INFO(integrator.name);
    const std::string words = "simulate s.toml --out o --quiet --integrator " + std::string(integrator.name) +
                              " --set cloth.0.stretch=20 cloth.0.bend=1e-6 cloth.0.translate=[0,-0.04,0] "
                              "simulation.relative_tolerance=1e-5";
    REQUIRE(shop.drape(words).exit_code == 0);
    const std::string csv = content(shop.path / "o/steps.csv");
    const std::vector<double> taken = column(csv, "inner_steps"), rejected = column(csv, "inner_rejected");
    REQUIRE(taken.size() == 30);
    REQUIRE(rejected.size() == 30);
    const double sum = std::accumulate(taken.begin(), taken.end(), 0.0),
                 vain = std::accumulate(rejected.begin(), rejected.end(), 0.0);
    CHECK((*std::min_element(taken.begin(), taken.end()) >= 1) == adaptive);
    if (!adaptive) CHECK(vain == 0);
    in_vain += vain;
    CHECK(vain < 0.5 * sum + 1);
    const Json json = shop.json("o/run.json");
    CHECK(json["inner_steps"]["mean"].get<double>() == Approx(sum / 30));
    CHECK(json["inner_steps"]["max"] == *std::max_element(taken.begin(), taken.end()));
    CHECK(json["inner_rejected"] == vain);
  }
  if (integrators().size() > 7) CHECK(in_vain > 0);  // the build has SUNDIALS
}

TEST_CASE("frames may be OBJ files or none, and only the last", "[cli]") {
  const Workshop shop;
  CHECK(shop.drape("simulate s.toml --out o --frames obj --quiet --set cloth.0.imperfection=0").exit_code ==
        0);
  CHECK(shop.files("o/frames").size() == 9);
  CHECK(shop.files("o/frames").contains("sheet_0001.obj"));
  CHECK(read_obj(shop.path / "o/frames/sheet_0001.obj").positions ==
        read_obj(shop.path / "sheet.obj").positions);
  CHECK(shop.drape("simulate s.toml --out n --frames none --quiet").exit_code == 0);
  CHECK(shop.files("n") == std::set<std::string>{"bodies", "run.json", "sheet.obj", "steps.csv"});
  CHECK(shop.drape("simulate s.toml --out l --set simulation.frame_rate=0 --quiet").exit_code == 0);
  CHECK(fs::file_size(shop.path / "l/sheet.pc2") == 32 + 169 * 12);
}

TEST_CASE("a run takes away the frames of an earlier one, and nothing else", "[cli]") {
  const Workshop shop;
  const std::string run = "simulate s.toml --out o --frames obj --quiet";
  REQUIRE(shop.drape(run).exit_code == 0);
  const auto frames = shop.files("o/frames");
  REQUIRE(frames.size() == 9);
  const std::set<std::string> others = {"sheet_5.obj",     "sheet_00006.obj",  "sheet_0009.obj.bak",
                                        "sheet_0009.txt",  "sheet_0009a.obj",  "other_0009.obj",
                                        "sheet_-0009.obj", "my_sheet_0009.obj"};
  for (const std::string& name : others) shop.write("o/frames/" + name, "mine");
  shop.write("o/frames/sheet_12345.obj", "of a long run");
  fs::create_directory(shop.path / "o/frames/sheet_0010.obj");
  CHECK(shop.drape(run + " --duration 100000 --set simulation.frame_rate=1e-5",
                   "timeout --preserve-status -s INT 1")
            .exit_code == 130);
  // A run that is not over has none but its own, either.
  CHECK(shop.files("o/frames").size() == 2 + others.size() + 1);
  CHECK(shop.drape("simulate hung.toml --out o --frames obj --quiet --set cloth.0.stretch=1e300").exit_code ==
        1);
  CHECK(shop.files("o/frames").size() == 1 + others.size() + 1);
  REQUIRE(shop.drape(run + " --duration 0.1").exit_code == 0);
  std::set<std::string> left = others;
  left.insert({"sheet_0001.obj", "sheet_0002.obj", "sheet_0003.obj", "sheet_0004.obj", "sheet_0010.obj"});
  CHECK(shop.files("o/frames") == left);
}

TEST_CASE("several cloths run together, each with its own files", "[cli]") {
  const Workshop shop;
  shop.write("two.toml", shop.cloth +
                             "name = \"upper\"\ntranslate = [0, 1, 0]\npins = [{ vertices = [84] }]\n" +
                             shop.cloth + "scale = 0.5\n[simulation]\nduration = 0.1\n");
  REQUIRE(shop.drape("simulate two.toml --out o").exit_code == 0);
  CHECK(shop.files("o") == std::set<std::string>{"fields", "run.json", "steps.csv", "sheet.obj", "sheet.pc2",
                                                 "upper.obj", "upper.pc2"});
  const TriangleMesh start = read_obj(shop.path / "sheet.obj"), upper = read_obj(shop.path / "o/upper.obj"),
                     lower = read_obj(shop.path / "o/sheet.obj");
  CHECK((upper.positions[84] - start.positions[84] - Vec3(0, 1, 0)).norm() < 1e-6);
  const double fallen = 9.81 * 0.01 * 0.01 * 55;  // implicit Euler: g h^2 (1 + 2 + ... + 10)
  CHECK((lower.positions[84] - 0.5 * start.positions[84] + fallen * Vec3::UnitY()).norm() < 1e-6);
}

TEST_CASE("quiet says nothing, a settled cloth stops a run, the last step meets the duration", "[cli]") {
  const Workshop shop;
  const Outcome run = shop.drape("simulate s.toml --out o --quiet --duration '95 ms' --time-step 0.02");
  CHECK(run.exit_code == 0);
  CHECK(run.out + run.err == "");
  CHECK(shop.json("o/run.json")["steps"] == 5);
  CHECK(shop.json("o/run.json")["simulated_seconds"].get<double>() == Approx(0.095).epsilon(1e-12));

  const std::string still = " --set simulation.gravity=[0,0,0] simulation.stop_when_settled=true";
  CHECK(shop.drape("simulate hung.toml --out q" + still).exit_code == 0);
  CHECK(shop.json("q/run.json")["state"] == "settled");
  CHECK(shop.json("q/run.json")["steps"].get<int>() <= 22);
}

TEST_CASE("a body that spins in its place is not settled", "[cli]") {
  const Workshop shop;
  shop.write("spin.toml", shop.cloth +
                              "pins = [{ box = [[-9, -9, -9], [9, 9, 9]] }]\n[simulation]\nduration = 0.4\n"
                              "gravity = [0, 0, 0]\nstop_when_settled = true\n[[obstacle]]\nshape = \"box\"\n"
                              "centre = [0, 5, 0]\nsize = [0.1, 0.06, 0.02]\nmass = 0.1\n");
  for (const auto& [rate, state] : {std::pair{"20 rad/s", "moving"}, {"1 mrad/s", "settled"}}) {
    INFO(rate);
    const std::string spin = std::string(" --set 'obstacle.0.spin={axis=[0,0,1],rate=\"") + rate + "\"}'";
    REQUIRE(shop.drape("simulate spin.toml --out o --frames none --quiet" + spin).exit_code == 0);
    const Json json = shop.json("o/run.json");
    CHECK(json["state"] == state);
    CHECK((json["simulated_seconds"].get<double>() > 0.39) == (json["state"] == "moving"));
    CHECK(json["bodies"][0]["spin"][2].get<double>() > 0);
  }
}

TEST_CASE("cloth that is still brought out of a body is not settled", "[cli]") {
  const Workshop shop;
  shop.write("under.toml", shop.cloth +
                               "[simulation]\nduration = 3\nstop_when_settled = true\n[[obstacle]]\n"
                               "shape = \"plane\"\npoint = [0, 0.45, 0]\n");
  const Outcome run = shop.drape("simulate under.toml --out o --frames none");
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("settled"));
  const Json json = shop.json("o/run.json");
  for (const Vec3& x : read_obj(shop.path / "o/sheet.obj").positions) CHECK(x[1] > 0.45);
  CHECK(json["simulated_seconds"].get<double>() > 0.1 / 0.25);
  CHECK(json["simulated_seconds"].get<double>() < 1);
  const Outcome cut = shop.drape("simulate under.toml --out o --frames none --duration 0.2");
  CHECK(shop.json("o/run.json")["state"] == "moving");
}

TEST_CASE("a settled cloth does not stop a run while a motion is still to come", "[cli]") {
  const Workshop shop;
  const std::string body = "[[obstacle]]\nshape = \"sphere\"\nradius = 0.1\ncentre = [0, 9, 0]\n";
  const std::string mesh = "[[obstacle]]\nshape = \"mesh\"\nmesh = \"ball.obj\"\ntranslate = [0, 9, 0]\n";
  const std::string keys =
      "motion = { keyframes = [{ time = 0.4 }, { time = 0.5, translate = [0, 0.01, 0] }] }";
  const std::pair<std::string, double> rows[] = {
      {body, 0.21},
      {body + keys + "\n", 0.7},
      {body + "motion = { velocity = [0, 0.1, 0] }\n", 1},  // without an end
      {body + "mass = 1\nvelocity = [0, 0.1, 0]\n", 1},
      {body + "mass = 1\n", 0.21},
      {mesh + "frames = [\"ball.obj\"]\n", 0.21},
      {mesh + "frames = [\"ball.obj\", \"ball.obj\"]\nframe_rate = 2\n", 0.7},
      {"[[cloth.pins]]\nvertices = [0]\n" + keys + "\n", 0.7},
  };
  for (const auto& [what, until] : rows) {
    INFO(what);
    shop.write("m.toml", shop.cloth + "model = \"noh-jung\"\n" + what +
                             "[simulation]\ngravity = [0, 0, 0]\nduration = 1\n" +
                             "stop_when_settled = true\nsettle_speed = 0.01\n");
    REQUIRE(shop.drape("simulate m.toml --out o --quiet").exit_code == 0);
    const double end = shop.json("o/run.json")["simulated_seconds"].get<double>();
    CHECK(end > until - 0.011);
    CHECK(end < until + 0.2);  // a pin leaves the cloth in motion
  }
}

TEST_CASE("a run gives the same bits with any number of threads", "[cli]") {
  const Workshop shop;
  std::set<std::string> hashes;
  for (const char* threads : {"1", "2", "7", "7"}) {
    REQUIRE(shop.drape(std::string("simulate s.toml --out o --quiet --threads ") + threads).exit_code == 0);
    hashes.insert(shop.json("o/run.json")["state_hash"].get<std::string>());
  }
  CHECK(hashes.size() == 1);
}

TEST_CASE("a cloth is dropped onto shapes, meshes and the floor", "[cli]") {
  const Workshop shop;
  for (const char* onto : {"sphere:0.3", "sphere:30cm", "box:0.4x0.2x0.4", "capsule:0.1x0.4", "bowl:0.3",
                           "plate:0.2", "plate:0.2x4cm", "plate:0.2x0.04x1mm", "plane", "ball.obj"}) {
    INFO(onto);
    const Outcome run =
        shop.drape(std::string("drop sheet.obj --floor --duration 0.1 --out o --onto ") + onto);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.err, !Contains("warning") || Contains("folds come out too stiff"));
    CHECK(shop.files("o") == usual_files);
  }
  CHECK_THAT(shop.json("o/run.json")["scene"].get<std::string>(), StartsWith("drape drop sheet.obj --floor"));
  CHECK(shop.drape("drop sheet.obj --duration 0.05").exit_code == 0);
  for (const std::string words :  // what drop sets by itself may be given by any way
       {"--tolerance 1e-3 --time-step '5 ms' --integrator bdf2 --linear-solver mpcg --threads 1 --scale 1",
        "--set simulation.tolerance=1e-3 --set simulation.stop_when_settled=false --set "
        "cloth.0.fabric=polyester-plain",
        "--set cloth.0.self_contact=false --set cloth.0.warp=[1,0,0] --set simulation.gravity=[0,-1,0]"}) {
    INFO(words);
    const Outcome run =
        shop.drape("drop sheet.obj --onto sphere:0.3 --floor --duration 0.02 --out o " + words);
    INFO(run.err);
    CHECK(run.exit_code == 0);
  }
  CHECK(shop.files("out/sheet") == without_bodies);
  CHECK(shop.drape("drop sheet.obj --onto sphere:0.3 --friction 0.1 --margin '3 mm' --fabric polyester-plain "
                   "--scale 0.5 "
                   "--duration 0.05 --set obstacle.0.friction=0.2 --set cloth.0.bend='5 uN.m' --out p")
            .exit_code == 0);
}

TEST_CASE("a dropped fabric has its warp down the cloth, and the run says where that is", "[cli][woven]") {
  const Workshop shop;  // its sheet lies
  TriangleMesh standing = grid(9, 9, 1, 1);
  for (Vec3& x : standing.positions) x = Vec3(x.x(), 1 - x.z(), 0.1 * x.x());
  shop.write("standing.obj", format_obj(standing, standing.positions));
  shop.write("alike.toml", "area_density = 0.15\nstretch = 500\nbend = 1e-5\n");
  for (const auto& [mesh, along] : {std::pair{"sheet.obj", 2}, std::pair{"standing.obj", 1}}) {
    INFO(mesh);
    const std::string words = std::string("drop ") + mesh + " --floor --duration 0.02 --out ";
    const Outcome run = shop.drape(words + "o --fabric polyester-twill");
    REQUIRE(run.exit_code == 0);
    CHECK_THAT(run.err, Contains("no direction of the warp is given: it runs down the cloth, along ") &&
                            Contains("set warp = [x, y, z]"));
    const Json fabric = shop.json("o/run.json")["cloths"][0]["fabric"];
    CHECK(fabric["model"] == "woven");
    const auto warp = fabric["weave"]["warp"].get<std::vector<double>>();
    CHECK(std::max_element(warp.begin(), warp.end()) - warp.begin() == along);
    // The same direction given is the same run, without the note.
    const std::string given = "[" + fabric["weave"]["warp"].dump().substr(1);
    const Outcome same = shop.drape(words + "p --fabric polyester-twill --set 'cloth.0.warp=" + given + "'");
    REQUIRE(same.exit_code == 0);
    CHECK_THAT(same.err, !Contains("no direction of the warp"));
    CHECK(shop.json("o/run.json")["state_hash"] == shop.json("p/run.json")["state_hash"]);
    for (const char* others : {" --fabric alike.toml --set cloth.0.compression=1",
                               " --fabric polyester-twill --set cloth.0.model=noh-jung"})
      CHECK_THAT(shop.drape(words + "q" + others).err, !Contains("no direction of the warp"));
    CHECK((shop.json("q/run.json")["cloths"][0]["fabric"]["model"] == "noh-jung"));
  }
  // The warp of a pattern is its grain.
  shop.write(
      "panel.toml",
      "unit = \"1 m\"\n\n[[panel]]\nname = \"p\"\noutline = [[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]]\n");
  const Outcome panel =
      shop.drape("drop panel.toml --floor --duration 0.02 --out q --fabric polyester-twill");
  INFO(panel.err);
  CHECK(panel.exit_code == 0);
  CHECK_THAT(panel.err, !Contains("no direction of the warp"));
}

TEST_CASE("a disc is draped over the plate of a drape test, and stays", "[cli]") {
  const Workshop shop;
  constexpr double radius = 0.15, plate = 0.09, rim = 0.005;  // m
  const TriangleMesh disc = drape::disc(15, radius);
  shop.write("disc.obj", format_obj(disc, disc.positions));
  const Outcome run = shop.drape("drop disc.obj --onto plate:0.09 --out o");
  REQUIRE(run.exit_code == 0);
  const Json json = shop.json("o/run.json");
  CHECK(json["max_speed"].get<double>() < 0.01);  // m/s: it has come to rest
  CHECK(json["max_penetration"].get<double>() < 1e-9);
  const TriangleMesh cloth = read_obj(shop.path / "o/disc.obj"),
                     body = read_obj(shop.path / "o/bodies/plate.obj");
  double top = -1, lowest = 1, farthest = 0, uneven = 0;
  for (const Vec3& x : body.positions) top = std::max(top, x.y());
  Vec3 middle = Vec3::Zero();
  const double height = cloth.positions[0].y();  // over the centre of the plate
  for (const Vec3& x : cloth.positions) {
    const double from_axis = std::hypot(x.x(), x.z());
    if (from_axis < plate - rim - 0.01) uneven = std::max(uneven, std::abs(x.y() - height));
    lowest = std::min(lowest, x.y());
    farthest = std::max(farthest, from_axis);
    middle += x / cloth.vertex_count();
  }
  CHECK(height > top);
  CHECK(height < top + 0.005);                       // lies on it, a margin above
  CHECK(uneven < 1e-3);                              // flat
  CHECK(lowest < height - 0.03);                     // hangs down
  CHECK(farthest < radius - 0.005);                  // and in
  CHECK(std::hypot(middle.x(), middle.z()) < 1e-3);  // has not slid off
}

TEST_CASE("a cloth that starts inside a body is warned of and brought out", "[cli]") {
  const Workshop shop;
  const Outcome run = shop.drape("simulate s.toml --out o --set cloth.0.translate=[0,-0.1,0] --duration 1");
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err,
             Contains("vertices of sheet start inside the sphere, the deepest (vertex 84) by 50 mm"));
  CHECK(shop.json("o/run.json")["warnings"].size() >= 1);
  CHECK(shop.json("o/run.json")["max_penetration"].get<double>() == Approx(0.05));
  double nearest = 1;
  for (const Vec3& x : read_obj(shop.path / "o/sheet.obj").positions) nearest = std::min(nearest, x.norm());
  CHECK(nearest > 0.3 - 1e-4);
}

TEST_CASE("check and list change nothing", "[cli]") {
  const Workshop shop;
  const std::set<std::string> before = shop.files(".");
  const Outcome scene = shop.drape("check s.toml"), mesh = shop.drape("check sheet.obj"),
                list = shop.drape("list");
  CHECK(scene.exit_code + mesh.exit_code + list.exit_code == 0);
  CHECK_THAT(scene.out, Contains("169 vertices") && Contains("obstacle sphere"));
  CHECK_THAT(mesh.out, Contains("288 triangles") && Contains("1 boundary loop"));
  CHECK_THAT(list.out, Contains("cotton-poplin") && Contains("capsule") && Contains("implicit-euler") &&
                           Contains("mpcg"));
  CHECK(shop.files(".") == before);
}

TEST_CASE("what a run writes is the same where standard streams are closed", "[cli]") {
  const Folder folder;
  const std::string run =
      "simulate '" + source_dir() + "/data/scenes/sheet-on-ball.toml' --duration 0.1 --out ";
  REQUIRE(folder.drape(run + "open").exit_code == 0);
  for (const std::string& closed : std::initializer_list<std::string>{"2>&-", ">&-", "<&-", "<&- >&- 2>&-"}) {
    INFO(closed);
    CHECK(folder.drape(run + "closed " + closed).exit_code == 0);
    CHECK(content(folder.path / "closed/sheet.pc2") == content(folder.path / "open/sheet.pc2"));
  }
}

TEST_CASE("what cannot be printed is told, but not to who stopped reading", "[cli]") {
  const Folder folder;
  if (fs::exists("/dev/full"))
    for (const std::string& words : std::initializer_list<std::string>{
             "list", "keys", "check '" + source_dir() + "/data/scenes/sheet-on-ball.toml'"}) {
      const Outcome full = folder.drape(words + " >/dev/full");
      CHECK(full.exit_code == 2);
      CHECK_THAT(full.err, Contains("could not be written: No space left on device"));
    }
  CHECK(folder.shell("{ sleep 0.3; '" + program() + "' keys; echo $? >&2; } | true").err == "0\n");
}

TEST_CASE("what is said of a start that contact cannot take as it is", "[cli]") {
  const Workshop shop;
  const auto warned = [&](const std::string& text) {
    shop.write("w.toml", shop.cloth + text + "[simulation]\nduration = 0.01\n");
    return shop.drape("check w.toml");
  };
  const std::string guarded = "self_contact = true\nthickness = \"1 mm\"\n";
  CHECK_THAT(warned(guarded).out, !Contains("from the origin"));
  CHECK_THAT(warned(guarded + "translate = [100, 0, 0]\n").out, Contains("reaches 100 m from the origin"));
  CHECK_THAT(warned(guarded).out, !Contains("thick for a cloth"));
  CHECK_THAT(warned("self_contact = true\nthickness = 0.1\n").out,
             Contains("warning: cloth sheet: layers 100 mm apart are thick for a cloth of "));
  const Outcome far = warned(guarded + "translate = [0, 0, -5000]\n");
  CHECK(far.exit_code == 2);
  CHECK(lines_of(far.err) == 1);
  CHECK_THAT(far.err, StartsWith("error: w.toml:1: cloth sheet: reaches 5000 m from the origin") &&
                          Contains("move the scene nearer to the origin"));
  CHECK(warned("translate = [0, 0, -5000]\n").exit_code == 0);
  CHECK_THAT(warned("[[obstacle]]\nshape = \"plane\"\npoint = [0, 0.349, 0]\nmargin = \"1 cm\"\n").out,
             Contains("note: 169 vertices of sheet start nearer to the plane than half of its margin of 10 "
                      "mm, the nearest"));
  CHECK_THAT(warned("[[obstacle]]\nshape = \"plane\"\npoint = [0, 0.34, 0]\nmargin = \"1 cm\"\n").out,
             !Contains("its margin"));
  shop.write("sheet.obj",
             "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\n"
             "f 1 3 4 2\nf 5 7 8 6\n");
  CHECK_THAT(warned(guarded).out, Contains("4 of its vertices are at the same place as another one"));
  CHECK_THAT(warned(guarded + "weld = true\n").out, !Contains("at the same place") && !Contains("coincide"));
  CHECK(shop.drape("simulate w.toml --out welded").exit_code == 0);
  const Outcome grid = warned("model = \"choi-ko\"\nweld = true\n");
  CHECK(grid.exit_code == 2);
  CHECK_THAT(grid.err,
             StartsWith("error: w.toml:") && Contains("weld = true: the springs of model = \"choi-ko\""));
  CHECK_THAT(warned(guarded + "model = \"woven\"\n").out, Contains("crossings: none"));
}

TEST_CASE("check says which seams begin closed", "[cli]") {
  // Two squares side by side; the second is at a distance from the first.
  const Workshop shop;
  const auto said = [&](double apart, const std::string& more) {
    std::ostringstream mesh;
    for (const double x : {0.0, 0.1, 0.1 + apart, 0.2 + apart})
      mesh << "v " << x << " 0 0\nv " << x << " 0.1 0\n";
    mesh << "f 1 3 4 2\nf 5 7 8 6\ng one\nl 3 4\ng two\nl 5 6\n";
    shop.write("two.obj", mesh.str());
    shop.write("two.toml",
               "[[cloth]]\nmesh = \"two.obj\"\nfabric = \"cotton-poplin\"\n[[cloth.seams]]\n"
               "curves = [\"one\", \"two\"]\ndirection = \"same\"\nclose = 2\n" +
                   more + "[simulation]\nduration = 3\n");
    const Outcome check = shop.drape("check two.toml");
    INFO(check.err);
    CHECK(check.exit_code == 0);
    return check.out;
  };
  CHECK_THAT(said(0, ""),
             Contains("2 pairs, up to 0 m apart, begins closed and is merged in the first step"));
  CHECK_THAT(said(0, "then = \"keep\"\n"), Contains("2 pairs, up to 0 m apart, closes in 2 s and is kept"));
  CHECK_THAT(said(0.05, ""), Contains("2 pairs, up to 0.05 m apart, closes in 2 s and is merged"));
}

TEST_CASE("check says how bodies and pins move", "[cli]") {
  const Workshop shop;
  shop.write("poses.csv", "time,x,y,z,qx,qy,qz,qw\n0.5,0,0,0,0,0,0,1\n2,0.3,0,0.4,0,0,0,1\n");
  const auto said = [&](const std::string& text) {
    shop.write("m.toml", shop.cloth + text + "[simulation]\nduration = 3\n");
    const Outcome check = shop.drape("check m.toml");
    INFO(text << check.err);
    CHECK(check.exit_code == 0);
    return check.out;
  };
  const std::string ball = "[[obstacle]]\nshape = \"sphere\"\nradius = 0.1\ncentre = [1, 0, 0]\n";
  CHECK_THAT(said(ball), Contains("\n  stands\n"));
  CHECK_THAT(said(ball + "motion = { keyframes = [{ time = 1, translate = [9, 9, 9] }] }\n"),
             Contains("\n  stands, as keyframes says\n"));
  CHECK_THAT(
      said(ball +
           "mass = \"250 g\"\nvelocity = [0, 3, 4]\nspin = { axis = [0, 1, 0], rate = \"90 deg/s\" }\n"),
      Contains("\n  mass 0.25 kg, moves by what acts on it: at first 5 m/s, 90 deg/s\n"));
  // There and back: as far as it gets, not as far as it ends.
  CHECK_THAT(
      said(ball +
           "motion = { keyframes = [{ time = 0.4 }, { time = 1, translate = [0, 0.5, 0], rotate = { axis "
           "= [0, 0, 1], angle = \"30 deg\" } }, { time = 1.56, translate = [0, 0, 0], rotate = { axis "
           "= [0, 0, 1], angle = 0 } }] }\n"),
      Contains("moved by keyframes, 0.4 to 1.56 s: by up to 0.5 m, turned by up to 30 deg\n"));
  CHECK_THAT(said(ball + "motion = { poses = \"poses.csv\" }\n"),
             Contains("moved by poses.csv, 0.5 to 2 s: by up to 0.5 m, turned by up to 0 deg\n"));
  // Half a turn about the origin takes the ball across; many turns are counted.
  CHECK_THAT(
      said(ball +
           "motion = { spin = { axis = [0, 1, 0], rate = \"6000 rpm\" }, centre = [0, 0, 0], start = 1 }\n"),
      Contains("moved by velocity and spin, 1 s on: by up to 2 m, turned by up to 7.2e+04 deg in the run\n"));
  CHECK_THAT(said(ball + "motion = { velocity = [1, 0, 0], start = 5 }\n"),
             Contains("moved by velocity and spin, 5 s on: after the end of the run\n"));
  const std::string pins = said(
      "[[cloth.pins]]\nvertices = [0, 1, 2]\nfollow = \"sphere\"\n[[cloth.pins]]\nvertices = "
      "[12]\n[[cloth.pins]]\n"
      "vertices = [5, 6]\nmotion = { velocity = [0, 0.1, 0], end = 2 }\n" +
      ball);
  CHECK_THAT(pins, Contains("\n6 vertices pinned, 3 to sphere, 2 along a path\n"));
  CHECK_THAT(
      pins,
      Contains("\n  2 vertices of sheet: moved by velocity and spin, 0 to 2 s: by up to 0.2 m, turned by "
               "up to 0 deg\n"));
}

TEST_CASE("a run is settled only when bodies with a mass are, too", "[cli]") {
  const Workshop shop;
  const std::string body =
      "pins = [{ vertices = [0, 12] }]\n[[obstacle]]\nshape = \"sphere\"\nradius = 0.1\ncentre = "
      "[0, 9, 0]\nmass = 1\n";
  for (const std::string velocity : {"0", "0.1"}) {
    INFO(velocity);
    shop.write("m.toml", shop.cloth + body + "velocity = [0, " + velocity + ", 0]\n" +
                             "[simulation]\ngravity = [0, 0, 0]\nduration = 0.1\n");
    const Outcome run = shop.drape("simulate m.toml --out o");
    REQUIRE(run.exit_code == 0);
    const std::string state = velocity == "0" ? "settled" : "moving";
    CHECK(shop.json("o/run.json")["state"] == state);
    CHECK_THAT(run.out, Contains("state: " + state));
  }
}

TEST_CASE("help and version end well", "[cli]") {
  const Workshop shop;
  for (const char* words :
       {"--help", "--version", "simulate --help", "drop --help", "check --help", "list --help"}) {
    INFO(words);
    const Outcome run = shop.drape(words);
    CHECK(run.exit_code == 0);
    CHECK_FALSE(run.out.empty());
    CHECK(run.err.empty());
  }
  CHECK_THAT(shop.drape("--version").out, StartsWith("drape "));
}
