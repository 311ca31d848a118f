// drape compare: systems taken out of a run, verdicts, tables and files, exit codes of the real program.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/compare/files.h"
#include "app/compare/html.h"
#include "app/compare/hung_sheet.h"
#include "app/compare/integrators.h"
#include "app/compare/options.h"
#include "app/compare/solvers.h"
#include "app/peak_memory.h"

using namespace drape;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;
namespace fs = std::filesystem;
using JsonValue = nlohmann::json;

namespace {

const std::string scenes = DRAPE_SOURCE_DIR "/data/scenes/";
const std::string on_ball = scenes + "sheet-on-ball.toml";

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

long count(const std::string& text, const std::string& what) {
  long found = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

// An empty folder in which `drape compare` runs.
struct Desk {
  fs::path path;
  Desk() {
    std::string name = (fs::temp_directory_path() / "drape-compare-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()));
    path = name;
  }
  ~Desk() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }

  int run(const std::string& words, const std::string& before = "") {
    const std::string line = "cd '" + path.string() + "' && " + before + " '" DRAPE_PROGRAM "' compare " +
                             words + " >.out 2>.err </dev/null";
    const int status = std::system(line.c_str());
    out = content(path / ".out");
    err = content(path / ".err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  JsonValue json() const { return JsonValue::parse(content(path / "o/compare.json")); }

  std::string out, err;
};

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

// The cells of one line of CSV.
Names cells(const std::string& line) {
  Names all(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      all.emplace_back();
    else
      all.back() += c;
  }
  return all;
}

// A CSV file holds what the rows of compare.json do.
void check_same_table(const std::string& text, const JsonValue& rows) {
  std::istringstream csv(text);
  std::string line;
  std::getline(csv, line);
  const Names header = cells(line);
  for (const JsonValue& row : rows) {
    REQUIRE(std::getline(csv, line));
    const Names found = cells(line);
    REQUIRE(found.size() == header.size());
    for (std::size_t k = 0; k < header.size(); ++k) {
      INFO(header[k]);
      REQUIRE(row.contains(header[k]));
      const JsonValue& value = row[header[k]];
      if (value.is_string()) CHECK(found[k] == value.get<std::string>());
      if (value.is_boolean()) CHECK(found[k] == (value.get<bool>() ? "1" : "0"));
      if (value.is_number()) CHECK(std::stod(found[k]) == Approx(value.get<double>()));
      if (value.is_null()) CHECK(found[k].empty());
    }
  }
  CHECK_FALSE(std::getline(csv, line));
}

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
  for (const JsonValue& run : json["runs"]) {  // the same in words, on the screen and in both files
    const std::string who = "implicit-euler at " +
                            std::string(run["time_step"] == 0.01    ? "0.01"
                                        : run["time_step"] == 0.005 ? "0.005"
                                                                    : "0.0025") +
                            " s with " + run["solver"].get<std::string>();
    const std::string verdict = run["verdict"], cause = run["differs_by"];
    const bool same = run["same_run_distance"] == 0;  // chance: to the last bit
    CHECK_THAT(verdict, StartsWith(run["reference"] == true ? "the reference"
                                   : same                   ? "no difference from the same run"
                                                            : "differs by " + cause + ": "));
    CHECK_THAT(desk.out, Contains(who + ": " + verdict + "\n"));
    if (cause == "linear algebra only") CHECK_THAT(verdict, EndsWith(" from the same run with mpcg"));
    CHECK(run["inner_steps"] == 0);
  }
  CHECK(json["verdicts"].size() == 2 + 4);
  check_same_table(content(desk.path / "o/compare-integrators.csv"), json["runs"]);
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

TEST_CASE("compare.json, compare.csv and compare.html hold it all", "[compare]") {
  Desk desk;
  REQUIRE(desk.run("--sizes 100,400 --steps 4 --repeats 1 --solvers mpcg,eigen-ldlt,mpcg@1e-1 --out o") == 1);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(desk.path / "o")) names.insert(entry.path().filename());
  CHECK(names ==
        std::set<std::string>{"compare-integrators.csv", "compare.csv", "compare.html", "compare.json"});

  const JsonValue json = desk.json();
  for (const char* key : {"drape_version", "scene", "integrator", "linear_solver", "time_step", "tolerance",
                          "threads", "steps", "at", "repeats", "sizes", "solvers", "agree", "verdicts",
                          "failure", "rows", "growth", "run_duration", "runs"}) {
    INFO(key);
    CHECK(json.contains(key));
  }
  CHECK(json["sizes"] == JsonValue({100, 400}));
  CHECK(json["growth"].size() == 3);
  REQUIRE(json["rows"].size() == 6);

  const std::string csv = content(desk.path / "o/compare.csv");
  const Names header = cells(csv.substr(0, csv.find('\n')));
  for (const char* key : {"vertices", "step", "solver", "iterations", "residual", "reported_residual",
                          "constraint_violation", "setup_ms", "solve_ms", "first_ms", "peak_memory_bytes",
                          "difference", "allowed", "cloth", "vertex", "stopped", "verdict"})
    CHECK(std::find(header.begin(), header.end(), key) != header.end());
  check_same_table(csv, json["rows"]);
  CHECK(count(content(desk.path / "o/compare-integrators.csv"), "\n") == 1);  // no runs

  const std::string html = content(desk.path / "o/compare.html");
  for (const char* outside : {"http", "src=", "<script", "<link", "@import", "url("})
    CHECK(count(html, outside) == 0);
  CHECK(count(html, "<svg") == 4);  // time, iterations, convergence of two sizes
  CHECK(count(html, "<title>") == 5);
  CHECK(count(html, "<table>") == count(html, "</table>"));
  CHECK_THAT(html, Contains("mpcg@1e-1: differ: sheet of 100 vertices"));
}

TEST_CASE("a long history is thinned out for the plot, not in compare.json", "[compare]") {
  Comparison comparison;
  comparison.tolerance = 1e-6;
  SolverRow row;
  row.vertices = 9, row.step = 1, row.solver = "long", row.agrees = true, row.report.iterations = 4999;
  for (int k = 0; k < 5000; ++k) row.history.push_back(std::exp(-0.01 * k));
  comparison.rows = {row};
  const std::vector<Plot> plots = plots_of(comparison);
  REQUIRE(plots.size() == 1);
  CHECK(plots[0].series[0].x.size() < 300);
  CHECK(plots[0].series[0].x.back() == 4999);
  CHECK(plots[0].series[0].y.back() == row.history.back());
  CHECK(JsonValue::parse(compare_json(comparison))["rows"][0]["history"].size() == 5000);
}

TEST_CASE("the script plots several compare.json", "[compare]") {
  const std::string python = "/usr/bin/python3 ",
                    script = python + "'" DRAPE_SOURCE_DIR "/tests/compare/plot_compare.py' ";
  if (std::system((python + "-c 'import matplotlib' 2>/dev/null").c_str()) != 0) {
    WARN("skipped: there is no matplotlib");
    return;
  }
  Desk desk;
  const auto plot = [&](const std::string& words) {
    const int status =
        std::system(("cd '" + desk.path.string() + "' && " + script + words + " >.out 2>.err").c_str());
    desk.err = content(desk.path / ".err");
    return WEXITSTATUS(status);
  };
  REQUIRE(desk.run("--sizes 16,36 --steps 2 --solvers mpcg --out o") == 0);
  REQUIRE(desk.run("'" + on_ball + "' --steps 2 --solvers mpcg --integrators implicit-euler --out p") == 0);
  JsonValue with_history = desk.json();
  with_history["rows"][0]["history"] = {1, 0.1, 0.01};
  std::ofstream(desk.path / "o/compare.json") << with_history;
  CHECK(plot("o/compare.json p/compare.json --out plots --format svg") == 0);
  INFO(desk.err);
  for (const char* name : {"time-against-vertices.svg", "convergence-o-16-step-2.svg", "work-precision.svg"})
    CHECK(fs::exists(desk.path / "plots" / name));

  std::ofstream(desk.path / "other.json") << "{}";
  for (const char* wrong : {"none.json", "other.json", ".out", "o"}) {
    INFO(wrong);
    CHECK(plot(wrong) == 2);
    CHECK_THAT(desk.err, StartsWith("error: ") && Contains(wrong));
    CHECK(count(desk.err, "\n") == 1);
  }
}

TEST_CASE("the growth is fitted", "[compare]") {
  Comparison comparison;
  comparison.at = {3};
  comparison.solvers = {"direct", "alone"};
  for (const int n : {1000, 4000, 16000}) {
    SolverRow row;
    row.vertices = n, row.step = 3, row.solver = "direct", row.solve_ms = 1e-3 * std::pow(n, 1.5);
    comparison.rows.push_back(row);
  }
  const std::vector<Growth> growth = growth_of(comparison);
  REQUIRE(growth.size() == 1);
  CHECK(growth[0].time == Approx(1.5));
  CHECK_FALSE(growth[0].iterations);
}

TEST_CASE("a plot leaves out what an axis cannot show", "[compare]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string text =
      svg({"a < b", "x", "y", true, true, {{"one & two", {1, 10, 100, 0, 5}, {1e-3, 1, nan, 1, -1}}}});
  CHECK(count(text, "<circle") == 2 + 1);  // and the legend's
  CHECK_THAT(text, Contains("a &lt; b") && Contains("one &amp; two") && !Contains("nan"));
  CHECK_THAT(svg({"empty", "x", "y", true, true, {{"zero", {0}, {0}}}}), Contains("nothing to plot"));
  CHECK_THAT(svg({"point", "x", "y", false, false, {{"one", {3}, {3}}}}), Contains("<circle"));
}

TEST_CASE("peak memory sees a block that has been freed again", "[compare]") {
  const PeakMemory memory;
  if (!memory.bytes()) return;  // this system cannot say
  {
    const std::vector<double> block(4000000, 1.0);
    CHECK(block.back() == 1);  // so that it is there
  }
  CHECK(*memory.kept() < 2e6);
  CHECK(*memory.bytes() > 30e6);
  CHECK(*memory.bytes() < 60e6);
}

TEST_CASE("the peak of a solver is over its set-up and all its solves, not over the others'", "[compare]") {
  if (!PeakMemory().bytes()) return;  // this system cannot say
  const Scene scene = hung_sheet_scene({});
  Recorded run(scene, make_hung_sheet(scene, 50));
  run.recording.on = true;
  SolverBench bench({{"mpcg", "mpcg", {}}, {"eigen-ldlt", "eigen-ldlt", {}}, {"mpcg@1e-3", "mpcg", 1e-3}},
                    1e-6, 1);
  std::vector<double> before(3, 0);
  for (int k = 1; k <= 4; ++k) {
    run.simulation.integrator->advance(run.simulation.state, 0.01);
    const auto rows = bench.compare(*run.recording.last, k, run.simulation);
    for (std::size_t s = 0; s < 3; ++s) {
      INFO("step " << k << ", " << rows[s].solver);
      REQUIRE(rows[s].peak_bytes);
      CHECK(*rows[s].peak_bytes >= before[s]);  // also where nothing is new
      before[s] = *rows[s].peak_bytes;
    }
    CHECK(before[1] > 5e6);              // the factor of 7500 rows
    CHECK(before[0] < 0.5 * before[1]);  // what others keep is not counted
    CHECK(before[2] < 0.5 * before[1]);
    CHECK(before[1] < 100e6);  // and nothing is counted at every step anew
  }
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
  fs::remove(desk.path / ".out");
  fs::remove(desk.path / ".err");
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
