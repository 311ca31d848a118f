// The program where something goes wrong: every kind of bad input, folders and disks that cannot be written,
// interrupted and failed runs.
#include <filesystem>
#include <fstream>

#include "tests/workshop.h"

#include "tests/places.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

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
  shop.write("noted.toml", shop.cloth + "self_contact = true\n");  // without a thickness, which is noted
  shop.write("pin.toml", shop.cloth + "pins = [{ group = \"collar\" }]\n");
  shop.write("box.toml", shop.cloth + "pins = [{ box = [[5, 5, 5], [6, 6, 6]] }]\n");
  shop.write("body.toml", shop.cloth + "[[obstacle]]\nshape = \"mesh\"\nmesh = \"none.obj\"\n");
  shop.write("weightless.toml", "bend = \"8 uN.m\"\n");
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
      {"check weightless.toml", "weightless.toml:1: the fabric: 'area_density' is missing"},
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
      {"simulate noted.toml --out sheet.obj/x", "cannot be made an output folder"},
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
      {"drop s.toml", "belongs to a scene, but a pattern is expected here; `drape simulate` runs a scene"},
      {"drop sheet.obj --onto none.obj", "none.obj: no such file"},
      {"drop sheet.obj --onto cube:1", "shapes are: plane, sphere"},
      {"drop sheet.obj --onto sphere", "such as sphere:0.3"},
      {"drop sheet.obj --onto sphere:-1", "greater than zero"},
      {"drop sheet.obj --onto sphere:1kg", "expected a length"},
      {"drop sheet.obj --onto box:1x2", "such as box:1x0.5x1"},
      {"drop sheet.obj --onto plate", "such as plate:0.09"},
      {"drop sheet.obj --onto plate:1x2x3x4", "such as plate:0.09"},
      {"drop sheet.obj --onto plate:0.09x0.02x0.02", "plate: rim must be"},
      {"drop sheet.obj --onto plane:1", "without a size: plane"},
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
    const std::size_t error = run.err.find("error: ");  // warnings may stand before it
    REQUIRE(error != std::string::npos);
    CHECK(lines_of(run.err.substr(error)) == 1);
    CHECK_THAT(run.err, Contains(mistake.message));
    CHECK((error == 0 || run.err.starts_with("warning: ") || run.err.starts_with("note: ")));
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

TEST_CASE("a frame does not replace the mesh beside which the program stands", "[cli]") {
  const Workshop shop;
  fs::create_directory(shop.path / "frames");
  fs::rename(shop.path / "sheet.obj", shop.path / "frames/sheet_0001.obj");
  shop.write("frames/s.toml",
             "[[cloth]]\nname = \"sheet\"\nmesh = \"sheet_0001.obj\"\nfabric = \"cotton-poplin\"\n");
  const std::string before = content(shop.path / "frames/sheet_0001.obj");
  const Outcome run = shop.shell("cd frames && '" + program() + "' simulate s.toml --frames obj --out ..");
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("would be overwritten"));
  CHECK(content(shop.path / "frames/sheet_0001.obj") == before);
}

TEST_CASE("a disk that fills up during a run leaves nothing half written", "[cli]") {
  const Workshop shop;
  // The limit of 20 blocks is 10 or 20 kB.
  const Outcome run = shop.drape("simulate s.toml --out o --quiet --duration 2", "ulimit -f 20;");
  CHECK(run.exit_code == 2);
  CHECK(lines_of(run.err) == 1);
  CHECK_THAT(run.err, StartsWith("error: o/") && Contains("cannot write: File too large"));
  CHECK(shop.files("o") == std::set<std::string>{"bodies", "fields"});
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

TEST_CASE("a run that is told to outlive its terminal does", "[cli]") {
  const Workshop shop;
  // run.json is written when the run ends, here by SIGTERM.
  const Outcome run = shop.shell(
      "trap '' HUP; '" + program() +
      "' simulate hung.toml --out o --quiet --duration 100000 --set simulation.frame_rate=1 & sleep 1; "
      "kill -s HUP $!; sleep 1; test ! -e o/run.json || exit 9; kill -s TERM $!; wait $!");
  CHECK(run.exit_code == 130);
  CHECK(shop.json("o/run.json")["interrupted"] == true);
}

TEST_CASE("an interrupted run leaves complete files", "[cli]") {
  const Workshop shop;
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    INFO(signal);
    const Outcome run =
        shop.drape("simulate hung.toml --out o --duration 100000 --set simulation.frame_rate=1",
                   std::string("env --default-signal=HUP timeout --preserve-status -s ") + signal + " 2");
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
  for (const auto& [absurd, term] :
       {std::pair{"stretch=1e300", "'membrane'"}, std::pair{"stretch_spring=1e305", "'stretch'"}}) {
    INFO(absurd);
    const Outcome run = shop.drape(std::string("simulate hung.toml --out o --quiet --set cloth.0.") + absurd);
    CHECK(run.exit_code == 1);
    CHECK(lines_of(run.err) == 1);
    CHECK_THAT(run.err, StartsWith("error: step ") && Contains(" of sheet (at ") &&
                            Contains(std::string("the term is ") + term) &&
                            Contains("try a smaller --time-step"));
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
  // Numbers beyond all range are refused before that.
  shop.write("beyond.toml", shop.cloth +
                                "[[obstacle]]\nshape = \"mesh\"\nmesh = \"ball.obj\"\n"
                                "translate = [0, -3, 0]\nmass = 1e-300\n");
  const Outcome beyond = shop.drape("simulate beyond.toml --out b --quiet");
  CHECK(beyond.exit_code == 2);
  CHECK(lines_of(beyond.err) == 1);
  CHECK_THAT(beyond.err, Contains("microgram"));
}
