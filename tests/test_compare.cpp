// drape compare: systems taken out of a run, verdicts, integrators, exit codes of the real program.
#include <catch2/catch.hpp>
#include <set>

#include "app/compare/hung_sheet.h"
#include "app/compare/integrators.h"
#include "app/compare/options.h"
#include "app/compare/solvers.h"
#include "app/peak_memory.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

namespace {

// A hung sheet whose steps are recorded.
struct Recorded {
  explicit Recorded(const Scene& scene, Simulation made) : simulation(std::move(made)) {
    simulation.integrator = make_integrator(
        "implicit-euler", *simulation.system, *simulation.constraints,
        std::make_unique<RecordingSolver>(make_linear_solver(scene.simulation.linear_solver), recording),
        scene.simulation.step);
  }
  Recording recording;
  Simulation simulation;
};

}  // namespace

TEST_CASE("the recorded system is the one that the step solved", "[compare]") {
  const Scene scene = hung_sheet_scene({parse_setting("simulation.linear_solver=\"mpcg\"")});
  Recorded run(scene, make_hung_sheet(scene, 12));
  for (int k = 0; k < 4; ++k) run.simulation.integrator->advance(run.simulation.state, 0.01);
  CHECK_FALSE(run.recording.last);

  run.recording.on = true;
  const State before = run.simulation.state;
  const StepReport report = run.simulation.integrator->advance(run.simulation.state, 0.01);
  REQUIRE(run.recording.last);
  const LinearSystem& system = *run.recording.last;
  REQUIRE(report.linear_solves == 1);
  VecX dv = system.solution;
  to_particles(system.A.pattern(), system.solution, dv);
  CHECK((run.simulation.state.v - before.v - dv).lpNorm<Eigen::Infinity>() < 1e-14);
  CHECK(system.filter.entries().size() == 2);
  CHECK(true_residual(system, system.solution) ==
        Approx(report.residual * reference_impulse(system)).epsilon(1e-6));
  CHECK(constraint_violation(system, system.solution) == 0);

  dv = system.guess;  // and it can be solved again, to the last bit
  make_linear_solver("mpcg")->solve(system.A, system.b, system.filter, system.options, dv);
  CHECK(dv == system.solution);
}

TEST_CASE("recording does not change the path", "[compare]") {
  const Scene scene = read_scene(on_ball, {});
  Recorded recorded(scene, make_simulation(scene));
  Simulation plain = make_simulation(scene);
  recorded.recording.on = true;
  for (int k = 0; k < 12; ++k) {
    recorded.simulation.integrator->advance(recorded.simulation.state, 0.01);
    plain.integrator->advance(plain.state, 0.01);
  }
  CHECK_FALSE(recorded.recording.last->filter.entries().empty());  // in contact
  CHECK(recorded.simulation.state.x == plain.state.x);
}

TEST_CASE("all solvers of the build agree: pins, contact, both", "[compare]") {
  Desk desk;
  const Names commands = {"--sizes 400 --steps 10", "'" + on_ball + "' --at 1,15",
                          scenes + "flag.toml --at 1,20",
                          "'" + on_ball + "' --at 15 --set cloth.0.pins='[{vertices=[0,5]}]'"};
  for (const std::string& words : commands) {
    INFO(words);
    CHECK(desk.run(words + " --repeats 1 --out o") == 0);
    INFO(desk.out << desk.err);
    const JsonValue json = desk.json();
    CHECK(json["agree"] == true);
    CHECK(json["rows"].size() >= linear_solvers().size());
    for (const JsonValue& row : json["rows"]) {
      CHECK(row["verdict"] == "agree");
      CHECK(row["residual"].get<double>() <= residual_slack * json["tolerance"].get<double>());
      if (row["allowed"].is_number()) CHECK(row["difference"].get<double>() <= row["allowed"].get<double>());
    }
  }
}

TEST_CASE("a loosened solver is caught, with the step and the vertex", "[compare]") {
  Desk desk;
  CHECK(desk.run("--sizes 400 --steps 6 --repeats 1 --solvers mpcg,eigen-ldlt,mpcg@1e-2 --out o") == 1);
  CHECK_THAT(
      desk.out,
      Contains("mpcg: agree\neigen-ldlt: agree\nmpcg@1e-2: differ: sheet of 400 vertices, step 6, vertex ") &&
          Contains(" of cloth 'sheet', by ") && Contains("asked 1e-06"));
  const JsonValue whole = desk.json();  // outlives the loop over a part of it
  for (const JsonValue& row : whole["rows"]) {
    const bool loose = row["solver"] == "mpcg@1e-2";
    CHECK(row["agrees"] == !loose);
    if (!loose) continue;
    CHECK(row["difference"].get<double>() > row["allowed"].get<double>());
    CHECK(row["vertex"].get<int>() < 400);
    CHECK(row["residual"].get<double>() > 1e-4);
    CHECK(row["stopped"] == "converged");  // its own word
  }
  CHECK(desk.run("--sizes 400 --steps 6 --repeats 1 --solvers mpcg@0.1,mpcg@1e-9 --out o --quiet") == 1);
  CHECK(desk.out.empty());
  CHECK_THAT(desk.err, StartsWith("error: mpcg@0.1: differ: "));
}

TEST_CASE("a solve that meets the tolerance differs by no more than is allowed", "[compare]") {
  const Scene scene = hung_sheet_scene({});
  Recorded run(scene, make_hung_sheet(scene, 14));
  run.recording.on = true;
  for (int k = 0; k < 8; ++k) run.simulation.integrator->advance(run.simulation.state, 0.01);
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    SolverBench bench({{"mpcg", "mpcg", {}}, {"eigen-ldlt", "eigen-ldlt", {}}}, tolerance, 1);
    const auto rows = bench.compare(*run.recording.last, 8, run.simulation);
    REQUIRE(rows.size() == 2);
    CHECK(rows[1].most_accurate);
    CHECK(rows[0].agrees);
    CHECK(rows[0].difference > 0);
    CHECK(rows[0].difference < *rows[0].allowed);
    CHECK(*rows[0].allowed < 300 * rows[0].difference);  // and the bound is not vain
  }
}

TEST_CASE("integrators: what differs by linear algebra, what by time integration", "[compare]") {
  Desk desk;
  REQUIRE(desk.run("'" + on_ball +
                   "' --linear-solver mpcg --at 1 --steps 5 --solvers mpcg,eigen-ldlt --integrators "
                   "implicit-euler --out o") == 0);
  const JsonValue json = desk.json();
  REQUIRE(json["runs"].size() == 4);
  std::multiset<std::string> causes;
  for (const JsonValue& run : json["runs"]) {
    CHECK(run["done"] == true);
    CHECK(run["end"].get<double>() == Approx(0.05));
    causes.insert(run["differs_by"].get<std::string>());
    CHECK(run["same_run_distance"].is_number() == (run["solver"] == "eigen-ldlt"));
    CHECK(run["reference"] == (run["time_step"] == 0.0025));
  }
  CHECK(causes == std::multiset<std::string>{"linear algebra only", "reference", "time integration",
                                             "time integration"});
  CHECK(json["runs"][0]["max_distance"].get<double>() > json["runs"][1]["max_distance"].get<double>());
  CHECK_THAT(desk.out, Contains("the reference: implicit-euler at 0.0025 s with mpcg"));
  CHECK(count(content(desk.path / "o/compare.html"), "<svg") == 2);
}

TEST_CASE("an integrator that fails is a row, not an end", "[compare]") {
  const Scene scene = read_scene(
      on_ball, {parse_setting("cloth.0.stretch=1e300"), parse_setting("simulation.linear_solver=\"mpcg\"")});
  CompareWords words;
  words.solvers = "mpcg";
  words.integrators = "implicit-euler";
  words.time_steps = "10ms,5ms";
  const CompareOptions options = compare_options(words);
  Comparison comparison;
  CHECK(compare_integrators(scene, options, 0.02, true, comparison));
  REQUIRE(comparison.runs.size() == 2);
  for (const IntegratorRow& row : comparison.runs) {
    CHECK_THAT(row.failure, StartsWith("step "));
    CHECK_FALSE(row.max_distance);
  }
}

TEST_CASE("peak memory sees a block that has been freed again", "[compare]") {
  const PeakMemory memory;
  if (!memory.bytes()) return;  // this system cannot say
  {
    const std::vector<double> block(4000000, 1.0);
    CHECK(block.back() == 1);  // so that it is there
  }
  CHECK(*memory.bytes() > 30e6);
  CHECK(*memory.bytes() < 60e6);
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
      {"--sizes 1k --integrators implicit-euler", "do not go together"},
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
}

TEST_CASE("a path that fails, an interrupt, a full disk", "[compare]") {
  Desk desk;
  const std::string scene = "'" + on_ball + "' --out o ";
  CHECK(desk.run(scene + "--steps 3 --set cloth.0.stretch=1e300") == 1);
  CHECK_THAT(desk.err, Contains("error: step 1 of the run with mpcg+block-ic0 failed: "));
  CHECK(desk.json()["failure"].is_string());
  CHECK(desk.json()["agree"] == false);
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
  CHECK(desk.run("'" + on_ball +
                 "' --sizes 100 --steps 2 --solvers mpcg --linear-solver eigen-ldlt --out o") == 0);
  CHECK(desk.json()["linear_solver"] == "eigen-ldlt");
  CHECK(desk.json()["tolerance"] == 1e-4);
  CHECK(desk.json()["rows"][0]["vertices"] == 100);
}
