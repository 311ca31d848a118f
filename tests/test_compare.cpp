// drape compare as a command: its options, bad input, exit codes of the real program, the sheet of --sizes.
#include <catch2/catch.hpp>

#include "app/compare/hung_sheet.h"
#include "app/compare/options.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

TEST_CASE("options are put in order, and what is not said follows from what is", "[compare]") {
  CompareWords words;
  words.at = "9,2,5";
  words.integrators = "bdf2";
  words.time_steps = "5ms,0.02,10 ms";
  CHECK(compare_options(words).at == std::vector<int>{2, 5, 9});
  CHECK(compare_options(words).time_steps == std::vector<double>{0.02, 0.01, 0.005});
  words = {};
  words.sizes = "1M,2.5k,16";
  CHECK(compare_options(words).sizes == std::vector<int>{16, 2500, 1000000});

  Desk desk;
  const auto steps = [&](const std::string& more) {
    CHECK(desk.run("'" + on_ball + "' --solvers mpcg --repeats 1 --out o " + more) == 0);
    return std::pair(desk.json()["steps"].get<int>(), desk.json()["at"].get<std::vector<int>>());
  };
  CHECK(steps("--at 2,4") == std::pair(4, std::vector<int>{2, 4}));
  CHECK(steps("--steps 5") == std::pair(5, std::vector<int>{1, 3, 5}));
  CHECK(steps("--steps 1") == std::pair(1, std::vector<int>{1}));
  CHECK(steps("") == std::pair(50, std::vector<int>{1, 25, 50}));  // the scene has 400
  CHECK(steps("--set simulation.duration=0.04") == std::pair(4, std::vector<int>{1, 2, 4}));
  for (const JsonValue json = desk.json(); const JsonValue& row : json["rows"])
    CHECK(row["time"].get<double>() == Approx(0.01 * row["step"].get<int>()));
}

TEST_CASE("bad input to compare: one line, exit code 2, nothing written", "[compare]") {
  Desk desk;
  const std::string scene = "'" + on_ball + "' ";
  const std::pair<std::string, const char*> table[] = {
      {"", "SCENE is required"},
      {"none.toml", "none.toml: no such file"},
      {scene + "--solvers mpgc", "did you mean 'mpcg'?"},
      {scene + "--solvers mpcg,", "with commas between"},
      {scene + "--solvers mpcg,mpcg", "'mpcg' is there twice"},
      {scene + "--solvers mpcg@", "NAME@TOLERANCE"},
      {scene + "--solvers mpcg@-1", "greater than zero"},
      {scene + "--solvers mpcg@1", "less than 1"},
      {scene + "--steps 0", "a whole number from 1"},
      {scene + "--steps 1.5", "a whole number from 1"},
      {scene + "--steps two", "a whole number from 1"},
      {scene + "--at 0", "a whole number from 1"},
      {scene + "--at 9 --steps 8", "--at 9: is after the last step"},
      {scene + "--repeats 0", "a whole number from 1"},
      {scene + "--integrators implicit-eulr", "did you mean 'implicit-euler'?"},
      {scene + "--integrators implicit-euler --time-steps -1", "a time step is greater than zero"},
      {scene + "--integrators implicit-euler --time-steps 1m", "expected a time"},
      {scene + "--time-steps 1", "--integrators, which is not given"},
      {"--sizes 3", "how many vertices"},
      {"--sizes 1q", "how many vertices"},
      {"--sizes 1k --integrators implicit-eulr", "did you mean 'implicit-euler'?"},
      {"--sizes 1k --set simulation.bent=3", "unknown key 'bent'"},
      {scene + "--threads 0", "--threads"},
      {scene + "--tolerance 0", "--tolerance"},
      {scene + "--linear-solver mpgc", "did you mean 'mpcg'?"},
      {scene + "--out /proc/drape", "cannot be made an output folder"},
      {scene + "--stepps 3", "--stepps"},
  };
  for (const auto& [words, message] : table) {
    INFO(words);
    CHECK(desk.run(words) == 2);
    CHECK(desk.out.empty());
    CHECK(count(desk.err, "\n") == 1);
    CHECK_THAT(desk.err, StartsWith("error: ") && Contains(message));
  }
  CHECK(fs::is_empty(desk.path));

  fs::create_directories(desk.path / "o/compare.csv");  // found before anything is computed
  CHECK(desk.run(scene + "--steps 100000 --out o") == 2);
  CHECK_THAT(desk.err, StartsWith("error: o/compare.csv: cannot write: Is a directory"));
}

TEST_CASE("a path that fails, an interrupt, a full disk", "[compare]") {
  Desk desk;
  const std::string scene = "'" + on_ball + "' --out o ";
  CHECK(desk.run(scene + "--steps 3 --set cloth.0.stretch=1e300") == 1);
  CHECK_THAT(desk.err, Contains("error: step 1 of the run with auto failed: "));
  CHECK(desk.json()["failure"].is_string());
  CHECK(desk.json()["agree"] == false);
  fs::remove_all(desk.path / "o");

  CHECK(desk.run("--sizes 16,36 --set cloth.0.stretch=1e300 --out o --quiet") == 1);  // ends with the first
  CHECK_THAT(desk.err, Contains("error: step 1 "));
  CHECK(desk.json()["sizes"] == JsonValue({16}));
  fs::remove_all(desk.path / "o");

  CHECK(desk.run(scene + "--at 100000", "timeout --preserve-status -s INT 2") == 130);
  CHECK(desk.out.empty());
  CHECK(fs::is_empty(desk.path / "o"));

  CHECK(desk.run(scene + "--at 1,2,3", "ulimit -f 8;") == 2);
  CHECK_THAT(desk.err, Contains("cannot write: File too large"));
  CHECK(fs::is_empty(desk.path / "o"));
}

TEST_CASE("a scene decides how the sheets of --sizes are solved", "[compare]") {
  Desk desk;
  CHECK(desk.run(
            "'" + on_ball +
            "' --sizes 100 --steps 2 --solvers mpcg --linear-solver eigen-ldlt --integrator bdf2 --threads 3 "
            "--out o") == 0);
  CHECK(desk.json()["integrator"] == "bdf2");
  CHECK(desk.json()["threads"] == 3);
  CHECK(desk.json()["linear_solver"] == "eigen-ldlt");
  CHECK(desk.json()["tolerance"] == 1e-4);
  CHECK(desk.json()["rows"][0]["vertices"] == 100);
}

TEST_CASE("the hung sheet hangs by two corners, and falls as it is told", "[compare]") {
  const Scene scene = hung_sheet_scene({parse_setting("simulation.gravity=[0,-1,2]")});
  const Simulation sheet = make_hung_sheet(scene, 7);
  CHECK(sheet.constraints->pinned() == std::vector<int>{0, 6});
  CHECK(sheet.system->gravity_acceleration() == Vec3(0, -1, 2));
  CHECK(sheet.state.particles() == 49);
  for (const int vertices : {16, 400, 1000, 40000})
    CHECK(std::abs(std::sqrt(vertices) - sheet_side(vertices)) <= 0.5);
}
