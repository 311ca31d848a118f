// What drape compare writes: tables that agree with each other, plots, the fitted growth,
// the script over several runs.
#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <set>
#include <sstream>

#include "app/compare/files.h"
#include "app/compare/html.h"
#include "app/compare/tables.h"
#include "app/view/page_template.h"
#include "tests/desk.h"

#include "tests/places.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

TEST_CASE("compare.json, compare.csv and compare.html hold it all", "[compare]") {
  Desk desk;
  REQUIRE(desk.run("--sizes 100,400 --steps 4 --repeats 1 --solvers mpcg,eigen-ldlt,mpcg@1e-1 --out o") == 1);
  CHECK(desk.files("o") ==
        std::set<std::string>{"compare-integrators.csv", "compare.csv", "compare.html", "compare.json"});

  const JsonValue json = desk.json();
  for (const char* key :
       {"drape_version", "scene", "integrator", "linear_solver", "time_step",    "tolerance", "threads",
        "steps",         "at",    "repeats",    "sizes",         "solvers",      "agree",     "verdicts",
        "failure",       "rows",  "growth",     "systems",       "run_duration", "runs"}) {
    INFO(key);
    CHECK(json.contains(key));
  }
  CHECK(json["sizes"] == JsonValue({100, 400}));
  CHECK(json["growth"].size() == 3);
  REQUIRE(json["rows"].size() == 6);

  const std::string csv = content(desk.path / "o/compare.csv");
  const std::vector<std::string> header = cells(csv.substr(0, csv.find('\n')));
  for (const char* key : {"vertices", "step", "solver", "iterations", "residual", "reported_residual",
                          "constraint_violation", "setup_ms", "solve_ms", "first_ms", "peak_memory_bytes",
                          "difference", "allowed", "cloth", "vertex", "stopped", "verdict"})
    CHECK(std::find(header.begin(), header.end(), key) != header.end());
  check_same_table(csv, json["rows"]);
  CHECK(count(content(desk.path / "o/compare-integrators.csv"), "\n") == 1);  // no runs

  const std::string html = content(desk.path / "o/compare.html");
  for (const char* outside : {"http:", "https:", "src=", "<link", "@import", "url("})
    CHECK(count(html, outside) == 0);
  check_plots(html, 4);  // time, iterations, convergence of two sizes
  CHECK(count(html, "<title>") == 1);
  CHECK(count(html, "<table>") == count(html, "</table>"));
  CHECK_THAT(html, Contains("mpcg@1e-1: differ: sheet of 100 vertices"));
}

namespace {

using MarketMatrix = Eigen::SparseMatrix<double>;

struct Market {
  std::string kind;  // the first line
  MarketMatrix values;
};

// A file of the Matrix Market, by its definition.
Market read_market(const fs::path& path) {
  Market read;
  std::istringstream text(content(path));
  std::string line;
  std::getline(text, read.kind);
  while (std::getline(text, line) && line.starts_with('%')) continue;
  std::istringstream sizes(line);
  int rows = 0, columns = 0, entries = 0;
  REQUIRE(sizes >> rows >> columns);
  std::vector<Eigen::Triplet<double>> all;
  double value = 0;
  bool lower = true, zeros = false;
  if (sizes >> entries) {
    for (int row = 0, column = 0; text >> row >> column >> value; --entries) {
      lower = lower && row >= column;
      zeros = zeros || value == 0;
      all.emplace_back(row - 1, column - 1, value);
      if (row != column) all.emplace_back(column - 1, row - 1, value);
    }
    CHECK(entries == 0);
  } else {
    for (int row = 0; row < rows && text >> value; ++row) all.emplace_back(row, 0, value);
    CHECK(all.size() == static_cast<std::size_t>(rows));
    CHECK_FALSE(text >> value);
  }
  CHECK(lower);
  CHECK_FALSE(zeros);
  read.values.resize(rows, columns);
  read.values.setFromTriplets(all.begin(), all.end());
  return read;
}

}  // namespace

TEST_CASE("saved systems are those of the steps, with their constraints, and are said to be there",
          "[compare]") {
  Desk desk;
  REQUIRE(desk.run("'" + on_ball +
                   "' --at 2,15 --repeats 1 --solvers mpcg,eigen-ldlt --save-systems --out o --set "
                   "cloth.0.pins='[{vertices=[0,5]}]' --set simulation.tolerance=1e-12") == 0);
  CHECK(desk.json()["systems"] == JsonValue({"systems/step-2", "systems/step-15"}));
  CHECK_THAT(desk.out, Contains("wrote o/systems/step-2\nwrote o/systems/step-15\n"));
  CHECK(desk.files("o/systems") == std::set<std::string>{"step-15", "step-2"});
  const fs::path folder = desk.path / "o/systems/step-15";
  const JsonValue about = JsonValue::parse(content(folder / "system.json"));
  std::set<std::string> listed = {"system.json"};
  for (const auto& [file, what] : about["files"].items()) {
    INFO(file);
    listed.insert(file);
    const Market read = read_market(folder / file);
    const bool vector = read.values.cols() == 1;
    CHECK(read.kind == (vector ? "%%MatrixMarket matrix array real general"
                               : "%%MatrixMarket matrix coordinate real symmetric"));
    CHECK(read.values.rows() == 3 * about["particles"].get<int>());
    CHECK_THAT(content(folder / file), Contains("\n% " + what.get<std::string>() + "\n"));
  }
  CHECK(desk.files("o/systems/step-15") == listed);
  CHECK(about["step"] == 15);
  CHECK(about["tolerance"] == 1e-12);
  CHECK(about["constrained"].get<int>() > 2);  // not only the pins

  const auto matrix = [&](const char* name) { return read_market(folder / name).values; };
  const auto vector = [&](const char* name) { return VecX(read_market(folder / name).values); };
  const MarketMatrix A = matrix("A.mtx"), S = matrix("S.mtx"), projected = matrix("A-projected.mtx");
  const VecX b = vector("b.mtx"), z = vector("z.mtx"), right = vector("b-projected.mtx");
  MarketMatrix I(A.rows(), A.cols());
  I.setIdentity();
  CHECK((S * S - S).norm() < 1e-13);
  CHECK(z.norm() > 0);
  CHECK((S * A * S + I - S - projected).norm() < 1e-13 * A.norm());
  CHECK((S * (b - A * z) - right).norm() < 1e-13 * b.norm());
  const auto solved = [](const MarketMatrix& of, const VecX& side) {
    return VecX(Eigen::SimplicialLDLT<MarketMatrix>(of).solve(side));
  };
  const VecX solution = S * solved(projected, right) + z;
  CHECK((solution - vector("dv.mtx")).lpNorm<Eigen::Infinity>() < 1e-8);
  CHECK((solution - vector("guess.mtx")).lpNorm<Eigen::Infinity>() > 1e-6);
  CHECK((solved(A, b) - solution).lpNorm<Eigen::Infinity>() > 1e-3);  // without the constraints

  REQUIRE(desk.run("--sizes 16,36 --steps 2 --solvers mpcg --save-systems --out sizes --quiet") == 0);
  CHECK(desk.files("sizes/systems") == std::set<std::string>{"16-vertices-step-2", "36-vertices-step-2"});
  CHECK(read_market(desk.path / "sizes/systems/36-vertices-step-2/A.mtx").values.rows() == 108);
  REQUIRE(desk.run("--sizes 16 --steps 2 --solvers mpcg --out plain") == 0);
  CHECK_FALSE(fs::exists(desk.path / "plain/systems"));
  desk.write("plain/systems", "in the way");
  CHECK(desk.run("--sizes 16 --steps 2 --solvers mpcg --save-systems --out plain") == 2);
  CHECK_THAT(desk.err, StartsWith("error: plain/systems: cannot be made an output folder: "));
  CHECK(count(desk.err, "\n") == 1);
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
                    script = python + "'" + source_dir() + "/tests/compare/plot_compare.py' ";
  if (std::system((python + "-c 'import matplotlib' 2>/dev/null").c_str()) != 0) {
    WARN("skipped: there is no matplotlib");
    return;
  }
  Desk desk;
  const auto plot = [&](const std::string& words) { return desk.said(desk.shell(script + words)); };
  REQUIRE(desk.run("--sizes 16,36 --steps 2 --solvers mpcg --out o") == 0);
  REQUIRE(desk.run("'" + on_ball + "' --steps 2 --solvers mpcg --integrators implicit-euler --out p") == 0);
  JsonValue with_history = desk.json();
  with_history["rows"][0]["history"] = {1, 0.1, 0.01};
  desk.write("o/compare.json", with_history.dump());
  CHECK(plot("o/compare.json p/compare.json --out plots --format svg") == 0);
  INFO(desk.err);
  for (const char* name : {"time-against-vertices.svg", "convergence-o-16-step-2.svg", "work-precision.svg"})
    CHECK(fs::exists(desk.path / "plots" / name));

  desk.write("other.json", "{}");
  desk.write("text.json", "step 1");
  for (const char* wrong : {"none.json", "other.json", "text.json", "o"}) {
    INFO(wrong);
    CHECK(plot(wrong) == 2);
    CHECK_THAT(desk.err, StartsWith("error: ") && Contains(wrong));
    CHECK(count(desk.err, "\n") == 1);
  }
}

TEST_CASE("a name with commas, quotes and angles is the same in every file", "[compare]") {
  Comparison comparison;
  comparison.scene = "a<b>&\"c\".toml";
  comparison.at = {1};
  SolverRow row;
  row.step = 1;
  row.solver = "x,\"y\"";
  row.verdict = "differ: <1, 2>\nand more";
  row.report.note = "one\ntwo, \"three\"";
  comparison.solvers = {row.solver};
  comparison.rows = {row};
  const JsonValue json = JsonValue::parse(compare_json(comparison));
  CHECK(json["scene"] == comparison.scene);
  CHECK(json["rows"][0]["note"] == row.report.note);

  const std::string csv = compare_csv(comparison);
  CHECK(count(csv, "\n") == 2);  // whatever is in a cell
  const std::string quoted = "\"x,\"\"y\"\"\"", text = csv.substr(csv.find('\n') + 1);
  CHECK_THAT(text, Contains("," + quoted + ","));
  CHECK(cells(text).size() == cells(csv.substr(0, csv.find('\n'))).size());

  const std::string page = compare_html(comparison), html = page.substr(0, page.find("<script>"));
  CHECK(count(html, "<b>") + count(html, "<1") + count(html, "\"c\"") == 0);
  CHECK(count(html, "a&lt;b&gt;&amp;&quot;c&quot;.toml") >= 2);
  CHECK_THAT(html, Contains("<td class=\"bad\">differ</td>"));
}

TEST_CASE("every number stands under its own name", "[compare]") {
  Comparison comparison;
  SolverRow row;
  row.vertices = 3, row.step = 4, row.constrained = 5, row.time = 0.5;
  row.tolerance = 1.5, row.residual = 2.5, row.violation = 3.5;
  row.setup_ms = 4.5, row.solve_ms = 5.25, row.first_ms = 6.5, row.difference = 7.5, row.allowed = 8.5;
  row.peak_bytes = 9.5, row.vertex = 6;
  row.report.iterations = 7, row.report.residual = 10.5, row.report.setup_ms = 11.5, row.report.analyses = 8;
  IntegratorRow run;
  run.time_step = 0.1, run.end = 0.2, run.steps = 1, run.steps_cut = 2, run.steps_not_converged = 3;
  run.linear_iterations = 4, run.wall_ms = 0.3, run.max_distance = 0.4, run.rms_distance = 0.5;
  run.energy_drift = 0.6, run.energy_error = 0.7, run.same_run_distance = 0.8;
  run.strain = 0.9, run.strain_error = 0.95;
  run.failure = "step 2: no";
  comparison.rows = {row};
  comparison.runs = {run};
  const JsonValue json = JsonValue::parse(compare_json(comparison)), solver = json["rows"][0],
                  one = json["runs"][0];
  const std::pair<const char*, double> of_solver[] = {{"vertices", 3},
                                                      {"step", 4},
                                                      {"constrained", 5},
                                                      {"time", 0.5},
                                                      {"tolerance", 1.5},
                                                      {"residual", 2.5},
                                                      {"constraint_violation", 3.5},
                                                      {"setup_ms", 4.5},
                                                      {"solve_ms", 5.25},
                                                      {"total_ms", 9.75},
                                                      {"first_ms", 6.5},
                                                      {"difference", 7.5},
                                                      {"allowed", 8.5},
                                                      {"vertex", 6},
                                                      {"peak_memory_bytes", 9.5},
                                                      {"iterations", 7},
                                                      {"reported_residual", 10.5},
                                                      {"first_setup_ms", 11.5},
                                                      {"analyses", 8}};
  for (const auto& [key, value] : of_solver) {
    INFO(key);
    CHECK(solver[key] == value);
  }
  const std::pair<const char*, double> of_run[] = {{"time_step", 0.1},
                                                   {"end", 0.2},
                                                   {"steps", 1},
                                                   {"steps_cut", 2},
                                                   {"steps_not_converged", 3},
                                                   {"linear_iterations", 4},
                                                   {"wall_ms", 0.3},
                                                   {"max_distance", 0.4},
                                                   {"rms_distance", 0.5},
                                                   {"energy_drift", 0.6},
                                                   {"energy_error", 0.7},
                                                   {"same_run_distance", 0.8},
                                                   {"strain", 0.9},
                                                   {"strain_error", 0.95}};
  for (const auto& [key, value] : of_run) {
    INFO(key);
    CHECK(one[key] == value);
  }
  CHECK(one["done"] == false);
  comparison.rows[0].vertex = -1;  // nothing differs
  comparison.rows[0].allowed.reset();
  const JsonValue none = JsonValue::parse(compare_json(comparison))["rows"][0];
  CHECK((none["vertex"].is_null() && none["allowed"].is_null()));
}

TEST_CASE("a solver agrees when all its rows do, and a table is of one step and size", "[compare]") {
  Comparison comparison;
  comparison.solvers = {"both", "one", "none"};
  for (const int n : {16, 36})
    for (const char* solver : {"both", "one"}) {
      SolverRow row;
      row.vertices = n, row.step = 1, row.solver = solver,
      row.agrees = solver == std::string("both") || n == 16;
      row.verdict = row.agrees ? "agree" : "differ: a lot";
      if (!row.agrees) row.report.note = "kernels of old";
      comparison.rows.push_back(row);
    }
  CHECK(verdicts(comparison) == Names{"both: agree", "one: differ: a lot"});
  IntegratorRow run;
  run.integrator = "bdf2", run.failure = "step 7: the cloth is torn", run.steps_cut = 5;
  comparison.runs = {run};
  CHECK(verdicts(comparison).size() == 3);
  CHECK(tables_of(comparison).size() == 4);  // and the work at equal strain
  const std::string text = text_of(comparison);
  CHECK_THAT(text, Contains("one: kernels of old") && Contains("step 7: the cloth is torn") &&
                       Contains("5 steps taken"));
}

TEST_CASE("a solver looks the same in every plot", "[compare]") {
  Comparison comparison;
  comparison.at = {1};
  comparison.sizes = {16, 36};
  comparison.solvers = {"direct", "slow", "quick"};
  for (const int n : comparison.sizes)
    for (const std::string& solver : comparison.solvers) {
      SolverRow row;
      row.vertices = n, row.step = 1, row.solver = solver, row.solve_ms = n;
      row.report.iterations = solver == "direct" ? 0 : n;
      comparison.rows.push_back(row);
    }
  const std::vector<Plot> plots = plots_of(comparison);
  REQUIRE(plots.size() == 4);
  for (const Plot& plot : plots)
    for (const Series& series : plot.series) {
      INFO(plot.title << ": " << series.name);
      if (series.dashed) continue;
      REQUIRE(series.look >= 0);
      CHECK(comparison.solvers[series.look] == series.name);
    }
  CHECK(plots[1].series.size() == 2);  // a direct solver has no iterations to show
}

TEST_CASE("work and precision: seconds against metres, without the reference and what failed", "[compare]") {
  Comparison comparison;
  for (int k = 0; k < 4; ++k) {
    IntegratorRow row;
    row.integrator = "bdf2", row.wall_ms = 500 * (k + 1), row.reference = k == 1;
    if (k != 2) row.max_distance = 0.1 * k;
    if (k == 3) row.solver = "another";
    comparison.runs.push_back(row);
  }
  const std::vector<Plot> plots = plots_of(comparison);
  REQUIRE(plots.size() == 1);
  REQUIRE(plots[0].series.size() == 2);
  CHECK(plots[0].series[0].x == std::vector<double>{0.5});
  CHECK(plots[0].series[1].x == std::vector<double>{2});
  CHECK(plots[0].series[1].y[0] == Approx(0.3));
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
  for (const int n : {1000, 4000, 16000}) {  // of another step: does not count
    SolverRow row;
    row.vertices = n, row.step = 1, row.solver = "direct", row.solve_ms = 1e-6 * std::pow(n, 3);
    comparison.rows.push_back(row);
  }
  const std::vector<Growth> growth = growth_of(comparison);
  REQUIRE(growth.size() == 1);
  CHECK(growth[0].time == Approx(1.5));
  CHECK_FALSE(growth[0].iterations);
}

TEST_CASE("a plot leaves out what an axis cannot show", "[compare]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto shown = [](const Plot& plot) { return JsonValue::parse(compact_json_text(json_of(plot))); };
  const std::vector<double> x = {1, 10, 100, 0, 5}, y = {1e-3, 1, nan, 1, -1};
  const JsonValue both = shown({"t", "x", "y", true, true, {{"a", x, y}, {"b", {2}, {3}}}});
  CHECK(both["series"][0]["x"] == JsonValue({1, 10}));
  CHECK(both["series"][0]["y"] == JsonValue({1e-3, 1}));
  CHECK(both["series"][1]["x"] == JsonValue::array({2}));
  for (const int k : {0, 1}) CHECK(both["series"][k]["look"] == k);  // their own colours and markers
  CHECK(shown({"t", "x", "y", false, false, {{"a", x, y}}})["series"][0]["x"] == JsonValue({1, 10, 0, 5}));
  CHECK(json_of({"empty", "x", "y", true, true, {{"zero", {0}, {0}}}}).is_null());
}

TEST_CASE("a plot without a point is a sentence, and names cannot end the page's data", "[compare]") {
  Comparison comparison;
  comparison.at = {1};
  comparison.sizes = {9};
  comparison.solvers = {"</script>"};
  SolverRow row;
  row.vertices = 9, row.step = 1, row.solver = "</script>", row.report.iterations = 3, row.residual = 0.5;
  comparison.rows = {row};
  const std::string html = compare_html(comparison);
  if (plot_script().empty()) {
    CHECK_THAT(html, Contains(missing_viewer()));
    return;
  }
  CHECK_THAT(html, Contains("Time against vertices: there is nothing to plot."));  // it took no time
  check_plots(html, 2);
  CHECK(count(html, "</script>") == 2);  // of the data and of the script
}
