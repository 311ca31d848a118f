// The integrators of drape compare: what differs by linear algebra and what by time integration; failures.
#include <set>

#include "app/compare/integrators.h"
#include "app/compare/options.h"
#include "app/compare/tables.h"
#include "app/simulation/simulation.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

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
  causes.erase(json["runs"][3]["same_run_distance"] == 0 ? "no difference" : "linear algebra only");
  CHECK(causes == std::multiset<std::string>{"reference", "time integration", "time integration"});
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
  check_plots(content(desk.path / "o/compare.html"), 2);
}

namespace {

// A run done by hand, and its sums.
struct ByHand {
  VecX x;
  double drift = 0;  // J
  int steps = 0, not_converged = 0;
  long iterations = 0;

  ByHand(const Scene& scene, const std::string& integrator, const std::vector<double>& time_steps,
         double tolerance) {
    Simulation s = make_simulation(scene);
    StepOptions options = scene.simulation.step;
    options.tolerance = tolerance;
    const auto stepper =
        make_integrator(integrator, *s.system, *s.constraints, make_linear_solver("mpcg"), options);
    const auto energy = [&] {
      return s.system->kinetic_energy(s.state.v) + s.system->elastic_energy(s.state.x) +
             s.system->gravity_energy(s.state.x);
    };
    const double start = energy();
    for (const double h : time_steps) {
      const StepReport report = stepper->advance(s.state, h);
      ++steps;
      not_converged += report.converged ? 0 : 1;
      iterations += report.linear_iterations;
    }
    x = s.state.x;
    drift = energy() - start;
  }
};

}  // namespace

TEST_CASE("the rows of integrators are those of the same runs done by hand", "[compare]") {
  const double tolerance = 1e-6;
  const Scene scene = read_scene(
      scenes + "flag.toml",
      {parse_setting("simulation.linear_solver=\"mpcg\""), parse_setting("simulation.tolerance=1e-6"),
       parse_setting("cloth.0.model=noh-jung"), parse_setting("simulation.max_linear_iterations=12")});
  CompareWords words;
  words.solvers = "mpcg@0.1";
  words.integrators = "implicit-euler,bdf2";
  words.time_steps = "10ms,20ms";
  Comparison comparison;
  REQUIRE(compare_integrators(
      scene, [&] { return make_simulation(scene); }, compare_options(words), 0.05, true, comparison));
  REQUIRE(comparison.runs.size() == 6);
  const std::vector<double> coarse = {0.02, 0.02, 0.01}, fine(5, 0.01);
  std::vector<ByHand> expected;
  for (const char* integrator : {"implicit-euler", "bdf2"}) {
    expected.emplace_back(scene, integrator, coarse, tolerance);
    expected.emplace_back(scene, integrator, fine, tolerance);
    expected.emplace_back(scene, integrator, coarse, 0.1);
  }
  int not_converged = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    const IntegratorRow& row = comparison.runs[k];
    INFO(row.integrator << " at " << row.time_step << " s with " << row.solver);
    CHECK(row.reference == (k == 1));
    CHECK(row.end == Approx(0.05));
    CHECK(row.steps == expected[k].steps);
    CHECK(row.linear_iterations == expected[k].iterations);
    CHECK(row.steps_not_converged == expected[k].not_converged);
    CHECK(row.energy_drift == Approx(expected[k].drift));
    CHECK(*row.energy_error == Approx(expected[k].drift - expected[1].drift).margin(1e-15));
    double most = 0, squares = 0;
    for (Eigen::Index i = 0; i < expected[k].x.size(); i += 3) {
      const double d = (expected[k].x - expected[1].x).segment<3>(i).norm();
      most = std::max(most, d);
      squares += d * d;
    }
    CHECK(*row.max_distance == Approx(most).margin(1e-15));
    CHECK(*row.rms_distance ==
          Approx(std::sqrt(3 * squares / static_cast<double>(expected[k].x.size()))).margin(1e-15));
    REQUIRE(row.same_run_distance.has_value() == (k % 3 == 2));
    if (k % 3 == 2) {
      double apart = 0;
      for (Eigen::Index i = 0; i < expected[k].x.size(); i += 3)
        apart = std::max(apart, (expected[k].x - expected[k - 2].x).segment<3>(i).norm());
      CHECK(apart > 0);
      CHECK(*row.same_run_distance == Approx(apart));
    }
    not_converged += row.steps_not_converged;
  }
  CHECK(not_converged > 0);
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
  CHECK(compare_integrators(
      scene, [&] { return make_simulation(scene); }, options, 0.02, true, comparison));
  REQUIRE(comparison.runs.size() == 2);
  for (const IntegratorRow& row : comparison.runs) {
    CHECK_THAT(row.failure, StartsWith("step "));
    CHECK_FALSE(row.max_distance);
    CHECK(row.differs_by == DiffersBy::not_known);
  }
  CHECK_FALSE(comparison.agree());
}

TEST_CASE("a run that fails ends drape compare with 1, whatever it differs by", "[compare]") {
  Desk desk;  // explicit Euler explodes at such a step, and needs no linear solver
  const std::string words = "'" + on_ball +
                            "' --linear-solver mpcg --solvers mpcg,eigen-ldlt --integrators "
                            "implicit-euler,explicit-euler --time-steps 40ms --repeats 1 --out o ";
  const std::string stiff = "--set cloth.0.stretch=1e5 --set simulation.duration=4 --steps 40";
  REQUIRE(desk.run(words + stiff) == 1);
  CHECK(count(desk.err, "error: explicit-euler at 0.04 s with ") == 2);
  const JsonValue json = desk.json();
  CHECK(json["agree"] == false);
  CHECK(json["failure"].is_null());  // the path itself went well
  REQUIRE(json["runs"].size() == 4);
  for (const JsonValue& run : json["runs"]) {
    const bool fails = run["integrator"] == "explicit-euler";
    CHECK(run["done"] == !fails);
    CHECK((run["differs_by"] == "not known") == fails);
    if (fails) CHECK_THAT(run["verdict"].get<std::string>(), StartsWith("failed after "));
  }
  CHECK_THAT(content(desk.path / "o/compare-integrators.csv"), Contains(",not known,"));
  CHECK_THAT(content(desk.path / "o/compare.html"), Contains("<td>not known</td>"));
  CHECK(desk.run(words + stiff + " --quiet") == 1);
  CHECK_THAT(desk.err, StartsWith("error: explicit-euler at 0.04 s with mpcg: failed after "));
}

TEST_CASE("what is the same to the last bit does not differ", "[compare]") {
  Comparison comparison;
  const Scene scene = read_scene(scenes + "flag.toml", {parse_setting("simulation.linear_solver=\"mpcg\""),
                                                        parse_setting("simulation.tolerance=1e-4")});
  CompareWords words;
  words.solvers = "mpcg,mpcg@1e-4,eigen-ldlt";  // the second is asked for what the scene asks for
  words.integrators = "bdf2,implicit-euler";    // of which the first begins with a step of the second
  words.time_steps = "10ms";
  REQUIRE(compare_integrators(
      scene, [&] { return make_simulation(scene); }, compare_options(words), 0.01, true, comparison));
  REQUIRE(comparison.runs.size() == 6);
  const Names verdicts = {"the reference",
                          "no difference from the same run with mpcg",
                          "differs by linear algebra only: ",
                          "no difference from the reference (bdf2 at 0.01 s with mpcg)",
                          "no difference from the same run with mpcg",
                          "differs by linear algebra only: "};
  for (std::size_t k = 0; k < 6; ++k) {
    const IntegratorRow& row = comparison.runs[k];
    INFO(row.integrator << " with " << row.solver);
    CHECK(row.differs_by == (k == 0       ? DiffersBy::reference
                             : k % 3 == 2 ? DiffersBy::linear_algebra
                                          : DiffersBy::nothing));
    comparison.reference_solver = "mpcg";
    CHECK_THAT(verdict_of(row, comparison), StartsWith(verdicts[k]));
  }
}

TEST_CASE("integrators on sheets of several sizes: a reference for each, and the work at equal strain",
          "[compare]") {
  Desk desk;
  REQUIRE(desk.run("--sizes 100,256 --solvers auto --steps 4 --integrators implicit-euler,pbd --time-steps "
                   "10ms,5ms --out o") == 0);
  const JsonValue json = desk.json();
  REQUIRE(json["runs"].size() == 8);
  for (const int vertices : {100, 256}) {
    int references = 0;
    for (const JsonValue& run : json["runs"])
      if (run["vertices"] == vertices && run["reference"] == true) {
        ++references;
        CHECK(run["integrator"] == "implicit-euler");
        CHECK(run["time_step"] == 0.005);
        CHECK(run["strain_error"] == 0);
        CHECK(run["strain"].get<double>() > 5e-4);
      }
    CHECK(references == 1);
    CHECK_THAT(desk.out, Contains("from the same start, " + std::to_string(vertices) + " vertices"));
    CHECK_THAT(desk.out, Contains("from the reference (implicit-euler at 0.005 s with auto, " +
                                  std::to_string(vertices)));
  }
  check_same_table(content(desk.path / "o/compare-integrators.csv"), json["runs"]);
  check_plots(content(desk.path / "o/compare.html"), 2 + 2 + 2);
}

TEST_CASE("work at equal strain: the cheapest run that is near enough", "[compare]") {
  Comparison comparison;
  const auto add = [&](const char* integrator, int vertices, double wall_ms, double strain_error) {
    IntegratorRow row;
    row.integrator = integrator;
    row.vertices = vertices;
    row.wall_ms = wall_ms;
    row.strain_error = strain_error;
    comparison.runs.push_back(row);
  };
  add("pbd", 100, 40, 0.02);
  add("pbd", 100, 90, -0.004);
  add("pbd", 100, 70, 0.006);
  add("pbd", 400, 800, 0.2);
  add("implicit-euler", 100, 30, 0);
  comparison.runs.back().reference = true;
  const ReportTable work = tables_of(comparison).back();
  CHECK(work.header == Names{"integrator", "vertices", "10 %", "3 %", "1 %", "0.3 %", "0.1 %", "0.03 %"});
  REQUIRE(work.rows.size() == 4);
  CHECK(work.rows[0] == Names{"pbd", "100", "40", "40", "70", "-", "-", "-"});
  CHECK(work.rows[1] == Names{"implicit-euler", "100", "-", "-", "-", "-", "-", "-"});
  CHECK(work.rows[2] == Names{"pbd", "400", "-", "-", "-", "-", "-", "-"});
}
