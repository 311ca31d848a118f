// The program as people run it: exit codes, files, messages, every kind of bad input, interrupted and failed
// runs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>

#include "mesh/generate.h"
#include "mesh/obj.h"
#include "solver/integrator.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

// A folder with a sheet of 13 x 13 vertices over a ball, in which the program runs.
struct Workshop : Folder {
  Workshop() {
    TriangleMesh sheet = grid(13, 13, 1, 1);
    for (Vec3& x : sheet.positions) x[1] = 0.35;
    write_obj(path / "sheet.obj", sheet, sheet.positions);
    const TriangleMesh ball = sphere(2, 0.3);
    write_obj(path / "ball.obj", ball, ball.positions);
    write("s.toml", cloth + "[simulation]\nduration = 0.3\n[[obstacle]]\nshape = \"sphere\"\nradius = 0.3\n");
    write("hung.toml", cloth + "pins = [{ vertices = [0, 12] }]\n[simulation]\nduration = 0.3\n");
  }
  Json json(const std::string& name) const { return Json::parse(content(path / name)); }

  const std::string cloth = "[[cloth]]\nmesh = \"sheet.obj\"\nfabric = \"cotton-poplin\"\n";  // three lines
};

long lines_of(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

const std::set<std::string> without_bodies = {"run.json", "sheet.obj", "sheet.pc2", "steps.csv"};
const std::set<std::string> usual_files = {"bodies", "run.json", "sheet.obj", "sheet.pc2", "steps.csv"};

}  // namespace

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
  CHECK(fs::file_size(shop.path / "o/sheet.pc2") == 32 + 8 * 169 * 12);  // 0, 0.04 ... 0.28 s
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
  CHECK(shop.drape("simulate s.toml --out o --frames obj --quiet").exit_code == 0);
  CHECK(shop.files("o/frames").size() == 8);
  CHECK(shop.files("o/frames").contains("sheet_0001.obj"));
  CHECK(read_obj(shop.path / "o/frames/sheet_0001.obj").positions ==
        read_obj(shop.path / "sheet.obj").positions);
  CHECK(shop.drape("simulate s.toml --out n --frames none --quiet").exit_code == 0);
  CHECK(shop.files("n") == std::set<std::string>{"bodies", "run.json", "sheet.obj", "steps.csv"});
  CHECK(shop.drape("simulate s.toml --out l --set simulation.frame_rate=0 --quiet").exit_code == 0);
  CHECK(fs::file_size(shop.path / "l/sheet.pc2") == 32 + 169 * 12);
}

TEST_CASE("a shorter run takes away the later frames of a longer one, and nothing else", "[cli]") {
  const Workshop shop;
  const std::string run = "simulate s.toml --out o --frames obj --quiet";
  REQUIRE(shop.drape(run).exit_code == 0);
  const auto frames = shop.files("o/frames");
  REQUIRE(frames.size() == 8);
  const std::set<std::string> others = {"sheet_5.obj",     "sheet_00006.obj",  "sheet_0009.obj.bak",
                                        "sheet_0009.txt",  "sheet_0009a.obj",  "other_0009.obj",
                                        "sheet_-0009.obj", "my_sheet_0009.obj"};
  for (const std::string& name : others) shop.write("o/frames/" + name, "mine");
  shop.write("o/frames/sheet_12345.obj", "of a long run");
  fs::create_directory(shop.path / "o/frames/sheet_0010.obj");
  CHECK(shop.drape(run + " --duration 100000 --set simulation.frame_rate=1e-5",
                   "timeout --preserve-status -s INT 1")
            .exit_code == 130);
  CHECK(shop.files("o/frames").size() == frames.size() + others.size() + 2);  // not yet over: all stay
  CHECK(shop.drape("simulate hung.toml --out o --frames obj --quiet --set cloth.0.stretch=1e300").exit_code ==
        1);
  CHECK(shop.files("o/frames").size() == frames.size() + others.size() + 2);
  REQUIRE(shop.drape(run + " --duration 0.1").exit_code == 0);
  std::set<std::string> left = others;
  left.insert({"sheet_0001.obj", "sheet_0002.obj", "sheet_0003.obj", "sheet_0010.obj"});
  CHECK(shop.files("o/frames") == left);
}

TEST_CASE("several cloths run together, each with its own files", "[cli]") {
  const Workshop shop;
  shop.write("two.toml", shop.cloth +
                             "name = \"upper\"\ntranslate = [0, 1, 0]\npins = [{ vertices = [84] }]\n" +
                             shop.cloth + "scale = 0.5\n[simulation]\nduration = 0.1\n");
  REQUIRE(shop.drape("simulate two.toml --out o").exit_code == 0);
  CHECK(shop.files("o") ==
        std::set<std::string>{"run.json", "steps.csv", "sheet.obj", "sheet.pc2", "upper.obj", "upper.pc2"});
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
  for (const char* onto :
       {"sphere:0.3", "sphere:30cm", "box:0.4x0.2x0.4", "capsule:0.1x0.4", "bowl:0.3", "plane", "ball.obj"}) {
    INFO(onto);
    const Outcome run =
        shop.drape(std::string("drop sheet.obj --floor --duration 0.1 --out o --onto ") + onto);
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.err, !Contains("warning"));
    CHECK(shop.files("o") == usual_files);
  }
  CHECK_THAT(shop.json("o/run.json")["scene"].get<std::string>(), StartsWith("drape drop sheet.obj --floor"));
  CHECK(shop.drape("drop sheet.obj --duration 0.05").exit_code == 0);
  CHECK(shop.files("out/sheet") == without_bodies);
  CHECK(shop.drape("drop sheet.obj --onto sphere:0.3 --friction 0.1 --margin '3 mm' --fabric polyester-plain "
                   "--scale 0.5 "
                   "--duration 0.05 --set obstacle.0.friction=0.2 --set cloth.0.bend='5 uN.m' --out p")
            .exit_code == 0);
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

TEST_CASE("bad input: one line, exit code 2, nothing written", "[cli]") {
  const Workshop shop;
  shop.write("empty.obj", "");
  shop.write("binary.obj", std::string("\x7f"
                                       "ELF\0\0\1\2",
                                       8));
  shop.write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  shop.write("faceless.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  shop.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  shop.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  shop.write("unknown.toml", shop.cloth + "bent = 3\n");
  shop.write("table.toml", "\n[[cloht]]\nmesh = \"sheet.obj\"\n");
  shop.write("bodies.toml", shop.cloth + "[[obstacles]]\nshape = \"plane\"\n");
  fs::create_directories(shop.path / "taken/sheet.obj");
  fs::create_directories(shop.path / "json/run.json");
  shop.write("unit.toml", shop.cloth + "bend = \"10 N/m\"\n");
  shop.write("pin.toml", shop.cloth + "pins = [{ group = \"collar\" }]\n");
  shop.write("box.toml", shop.cloth + "pins = [{ box = [[5, 5, 5], [6, 6, 6]] }]\n");
  shop.write("body.toml", shop.cloth + "[[obstacle]]\nshape = \"mesh\"\nmesh = \"none.obj\"\n");
  shop.write("syntax.toml", shop.cloth + "bend = = 3\n");
  shop.write("binary.toml", std::string("a\0b", 3));
  fs::create_directory(shop.path / "locked");
  const std::set<std::string> before = shop.files(".");

  struct Mistake {
    const char *words, *message;
  };
  const Mistake table[] = {
      {"", "subcommand"},
      {"simulat s.toml", "did you mean 'simulate'?"},
      {"simulate", "SCENE is required"},
      {"simulate s.toml --sped 3", "--sped"},
      {"simulate s.toml extra", "expected PATH=VALUE"},
      {"simulate none.toml", "none.toml: no such file"},
      {"simulate ''", "the word after 'simulate' is empty"},
      {"''", "the word after 'drape' is empty"},
      {"simulate s.toml --out ''", "the word after '--out' is empty"},
      {"simulate s.toml --out=", "there is nothing after '--out='"},
      {"drop sheet.obj --onto ''", "the word after '--onto' is empty"},
      {"simulate table.toml", "table.toml:2: unknown table 'cloht' in the scene; did you mean 'cloth'?"},
      {"simulate bodies.toml",
       "bodies.toml:4: unknown table 'obstacles' in the scene; did you mean 'obstacle'?"},
      {"simulate s.toml --out taken", "taken/sheet.obj: cannot write: Is a directory"},
      {"simulate s.toml --out json", "json/run.json: cannot write: Is a directory"},
      {"simulate locked", "is a directory"},
      {"simulate syntax.toml", "syntax.toml:4: is not TOML"},
      {"simulate binary.toml", "is binary"},
      {"simulate unknown.toml", "unknown.toml:4: unknown key 'bent'"},
      {"simulate unit.toml", "unit.toml:4: bend = \"10 N/m\": expected a bending rigidity"},
      {"simulate pin.toml", "pin.toml:4: pins: the mesh has no group 'collar'"},
      {"simulate box.toml", "holds no vertex"},
      {"simulate body.toml", "none.obj: no such file"},
      {"simulate s.toml --threads 0", "--threads: threads = 0"},
      {"simulate s.toml --threads two", "--threads"},
      {"simulate s.toml --time-step -1", "--time-step: time_step = -1: expected a time greater than zero"},
      {"simulate s.toml --duration '2 m'", "--duration: duration = \"2 m\": expected a time"},
      {"simulate s.toml --tolerance 0", "--tolerance"},
      {"simulate s.toml --integrator rk5", "there is no such integrator"},
      {"simulate s.toml --linear-solver mpgc", "did you mean 'mpcg'?"},
      {"simulate s.toml --frames avi", "--frames"},
      {"simulate s.toml --set cloth.0.stretch=-5", "not negative"},
      {"simulate s.toml --set cloth.0.fabric=wol", "there is no such fabric"},
      {"simulate s.toml --set cloth.0.mesh=empty.obj", "the file is empty"},
      {"simulate s.toml --out sheet.obj", "sheet.obj: cannot be made an output folder"},
      {"simulate s.toml --out sheet.obj/x", "cannot be made an output folder"},
      {"simulate s.toml --out /proc/drape", "cannot be made an output folder"},
      {"simulate s.toml --out .", "would be overwritten"},
      {"drop none.obj", "none.obj: no such file"},
      {"drop empty.obj", "empty.obj: the file is empty"},
      {"drop binary.obj", "binary.obj: is a binary file"},
      {"drop beyond.obj", "beyond.obj:4: face refers to vertex 9, "},
      {"drop faceless.obj", "faceless.obj: no faces"},
      {"drop nan.obj", "nan.obj:2"},
      {"drop flat.obj", "no triangle has an area"},
      {"drop locked", "is a directory"},
      {"drop sheet.obj --onto none.obj", "none.obj: no such file"},
      {"drop sheet.obj --onto cube:1", "shapes are: sphere"},
      {"drop sheet.obj --onto sphere", "such as sphere:0.3"},
      {"drop sheet.obj --onto sphere:-1", "greater than zero"},
      {"drop sheet.obj --onto sphere:1kg", "expected a length"},
      {"drop sheet.obj --onto box:1x2", "such as box:1x0.5x1"},
      {"drop sheet.obj --fabric wool", "--fabric: fabric = \"wool\": there is no such fabric"},
      {"drop sheet.obj --scale 0", "--scale"},
      {"drop sheet.obj --floor --friction -1", "--friction"},
      {"drop sheet.obj --friction 0.2", "--friction: there is nothing to touch"},
      {"drop sheet.obj --margin '1 mm'", "--margin: there is nothing to touch"},
      {"drop sheet.obj --pin collar", "--pin: pins: the mesh has no group 'collar'"},
      {"check none.obj", "none.obj: no such file"},
      {"check flat.obj", "no triangle has an area"},
      {"check pin.toml", "pin.toml:4"},
  };
  for (const Mistake& mistake : table) {
    INFO(mistake.words);
    const Outcome run = shop.drape(mistake.words);
    CHECK(run.exit_code == 2);
    CHECK(run.out == "");
    CHECK(lines_of(run.err) == 1);
    CHECK_THAT(run.err, StartsWith("error: ") && Contains(mistake.message));
  }
  CHECK(shop.files(".") == before);
}

TEST_CASE("an output folder without permission is refused", "[cli]") {
  const Workshop shop;
  fs::create_directory(shop.path / "locked");
  fs::permissions(shop.path / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  if (std::ofstream(shop.path / "locked/try")) {
    WARN("skipped: this user may write everywhere");
    return;
  }
  const Outcome run = shop.drape("simulate s.toml --quiet --out locked");
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("locked") && Contains("cannot"));
}

TEST_CASE("a disk that fills up during a run leaves nothing half written", "[cli]") {
  const Workshop shop;
  const Outcome run =
      shop.drape("simulate s.toml --out o --quiet --duration 2", "ulimit -f 20;");  // 10 or 20 kB
  CHECK(run.exit_code == 2);
  CHECK(lines_of(run.err) == 1);
  CHECK_THAT(run.err, StartsWith("error: o/") && Contains("cannot write: File too large"));
  CHECK(shop.files("o") == std::set<std::string>{"bodies"});
  CHECK(shop.files("o/bodies").empty());
}

TEST_CASE("a disk that fills up leaves the results of the run before", "[cli]") {
  const Workshop shop;
  REQUIRE(shop.drape("simulate s.toml --out o --quiet").exit_code == 0);
  const std::string before = content(shop.path / "o/sheet.obj") + content(shop.path / "o/run.json");
  CHECK(shop.drape("simulate s.toml --out o --quiet --duration 2", "ulimit -f 20;").exit_code == 2);
  CHECK(shop.files("o") == usual_files);
  CHECK(content(shop.path / "o/sheet.obj") + content(shop.path / "o/run.json") == before);
}

TEST_CASE("an interrupted run leaves complete files", "[cli]") {
  const Workshop shop;
  for (const char* signal : {"INT", "TERM"}) {
    INFO(signal);
    const Outcome run =
        shop.drape("simulate hung.toml --out o --duration 100000 --set simulation.frame_rate=1",
                   std::string("timeout --preserve-status -s ") + signal + " 2");
    CHECK(run.exit_code == 130);
    CHECK_THAT(run.out, Contains("interrupted after"));
    CHECK(shop.files("o") == without_bodies);
    const Json json = shop.json("o/run.json");
    CHECK(json["interrupted"] == true);
    const long steps = json["steps"].get<long>();
    CHECK(steps > 0);
    CHECK(lines_of(content(shop.path / "o/steps.csv")) == steps + 1);
    CHECK((fs::file_size(shop.path / "o/sheet.pc2") - 32) % (169 * 12) == 0);
  }
}

TEST_CASE("a failed computation says where, ends with 1 and keeps what went before", "[cli]") {
  const Workshop shop;
  for (const char* absurd : {"stretch=1e300", "stretch_spring=1e305"}) {
    INFO(absurd);
    const Outcome run = shop.drape(std::string("simulate hung.toml --out o --quiet --set cloth.0.") + absurd);
    CHECK(run.exit_code == 1);
    CHECK(lines_of(run.err) == 1);
    CHECK_THAT(run.err, StartsWith("error: step ") && Contains(" of sheet (at ") &&
                            Contains("the term is 'stretch'") && Contains("try a smaller --time-step"));
    CHECK(shop.files("o") == without_bodies);
    const Json json = shop.json("o/run.json");
    CHECK(json["state"] == "failed");
    for (const char* key : {"step", "time", "what", "term", "cloth", "vertex"})
      CHECK(json["failure"].contains(key));
    CHECK(lines_of(content(shop.path / "o/steps.csv")) == json["steps"].get<long>() + 1);
  }
  const Outcome far =
      shop.drape("simulate s.toml --out o --quiet --duration 2 --set simulation.gravity=[0,-1e308,0]");
  CHECK(far.exit_code == 1);
  CHECK_THAT(far.err, StartsWith("error: step "));
}
