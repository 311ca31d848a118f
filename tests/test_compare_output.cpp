// What drape compare writes: tables that agree with each other, plots, the fitted growth, the script over
// several runs.
#include <catch2/catch.hpp>
#include <sstream>

#include "app/compare/files.h"
#include "app/compare/html.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

namespace {

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

}  // namespace

TEST_CASE("compare.json, compare.csv and compare.html hold it all", "[compare]") {
  Desk desk;
  REQUIRE(desk.run("--sizes 100,400 --steps 4 --repeats 1 --solvers mpcg,eigen-ldlt,mpcg@1e-1 --out o") == 1);
  CHECK(desk.files("o") == std::set<std::string>{"compare.csv", "compare.html", "compare.json"});

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

  std::istringstream csv(content(desk.path / "o/compare.csv"));
  std::string line;
  std::getline(csv, line);
  const Names header = cells(line);
  for (const char* key : {"vertices", "step", "solver", "iterations", "residual", "reported_residual",
                          "constraint_violation", "setup_ms", "solve_ms", "first_ms", "peak_memory_bytes",
                          "difference", "allowed", "cloth", "vertex", "stopped", "verdict"})
    CHECK(std::find(header.begin(), header.end(), key) != header.end());
  for (const JsonValue& row : json["rows"]) {
    REQUIRE(std::getline(csv, line));
    const Names found = cells(line);
    REQUIRE(found.size() == header.size());
    for (std::size_t k = 0; k < header.size(); ++k) {
      INFO(header[k]);
      const JsonValue& value = row[header[k]];
      if (value.is_string()) CHECK(found[k] == value.get<std::string>());
      if (value.is_number()) CHECK(std::stod(found[k]) == Approx(value.get<double>()));
      if (value.is_null()) CHECK(found[k].empty());
    }
  }

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
