// drape compare: systems taken out of a run, verdicts, integrators, exit codes of the real program.
#include <Eigen/Dense>
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
using Catch::EndsWith;
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

TEST_CASE("a row holds what dense algebra says of its solution", "[compare]") {
  const Scene scene = hung_sheet_scene({});
  Recorded run(scene, make_hung_sheet(scene, 6));
  run.recording.on = true;
  for (int k = 0; k < 8; ++k) run.simulation.integrator->advance(run.simulation.state, 0.01);
  LinearSystem system = *run.recording.last;
  const BlockPattern& pattern = system.A.pattern();
  const Eigen::Index n = system.b.size();
  Eigen::MatrixXd D(n, n), S = Eigen::MatrixXd::Identity(n, n);
  VecX z = VecX::Zero(n), column(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    system.A.multiply(VecX::Unit(n, k), column);
    D.col(k) = column;
  }
  system.filter.clear();
  for (int row = 0; row < 36; row += 5) {  // locked, or sliding and moved along
    const Vec3 p = Vec3(1, 2 + row, -1).normalized();
    const bool locked = row % 2 == 0;
    system.filter.constrain(row, locked ? Mat3(Mat3::Zero()) : Mat3(Mat3::Identity() - p * p.transpose()),
                            0.1 * p);
    S.block<3, 3>(3 * row, 3 * row) = system.filter.entries().back().S;
    z.segment<3>(3 * row) = 0.1 * p;
  }
  const double reference = 2 * (S * (system.b - D * z)).norm();
  system.options.scale = reference;         // which is the larger then
  Simulation& simulation = run.simulation;  // as if it were two cloths
  Cloth upper, lower;
  upper.name = "upper", lower.name = "lower";
  upper.mesh.positions.resize(1), lower.mesh.positions.resize(35);
  lower.first_particle = 1;
  simulation.cloths = {upper, lower};

  VecX loose = system.guess, best = system.guess;
  LinearOptions options = system.options;
  options.tolerance = 1e-2;
  make_linear_solver("mpcg")->solve(system.A, system.b, system.filter, options, loose);
  options.tolerance = 1e-4;
  make_linear_solver("mpcg")->solve(system.A, system.b, system.filter, options, best);
  int worst = 0;
  const auto apart = [&](int row) { return (loose - best).segment<3>(3 * row).norm(); };
  for (int row = 1; row < 36; ++row)
    if (apart(row) > apart(worst)) worst = row;
  VecX Su = VecX::Zero(n);
  Su.segment<3>(3 * worst) = (loose - best).segment<3>(3 * worst).normalized();
  Su = S * Su;
  const VecX g = (S * D * S + Eigen::MatrixXd::Identity(n, n) - S).ldlt().solve(Su);
  const double r_best = (S * (system.b - D * best)).norm() / reference;

  SolverBench bench({{"mpcg@1e-2", "mpcg", 1e-2}, {"mpcg@1e-4", "mpcg", 1e-4}}, 1e-4, 1);
  const std::vector<SolverRow> rows = bench.compare(system, 8, simulation);
  REQUIRE(rows.size() == 2);
  CHECK(rows[1].most_accurate);
  CHECK(rows[0].residual == Approx((S * (system.b - D * loose)).norm() / reference));
  CHECK(rows[1].residual == Approx(r_best));
  CHECK(rows[0].difference == Approx(apart(worst)));
  CHECK(*rows[0].allowed == Approx(g.norm() * reference * (1.05e-4 + r_best)).epsilon(1e-4));
  const int particle = pattern.particle_of()[static_cast<std::size_t>(worst)];
  CHECK(rows[0].cloth == (particle == 0 ? "upper" : "lower"));
  CHECK(rows[0].vertex == (particle == 0 ? 0 : particle - 1));

  // Missing the tolerance is enough to differ, where the place that differs most would be allowed, too.
  std::vector<SolverChoice> choices = {{"mpcg@1e-9", "mpcg", 1e-9}};
  for (double t = 1e-4; t < 1e-3; t *= 1.2) choices.push_back({"mpcg@" + std::to_string(t), "mpcg", t});
  int missed = 0;
  for (const SolverRow& row : SolverBench(choices, 1e-4, 1).compare(system, 8, simulation)) {
    const bool meets = row.residual <= 1.05e-4, allowed = !row.allowed || row.difference <= *row.allowed;
    CHECK(row.agrees == (meets && allowed));
    CHECK((allowed || !meets));
    missed += allowed && !meets;
  }
  CHECK(missed > 0);

  VecX off = best;
  off.segment<3>(0) += Vec3(0, 0.25, 0);  // of a locked one
  CHECK(constraint_violation(system, off) == Approx(0.25));
  off[3 * system.filter.entries().front().particle] = std::nan("");
  CHECK_FALSE(constraint_violation(system, off) <= 1e300);
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
  const Scene scene =
      read_scene(scenes + "flag.toml", {parse_setting("simulation.linear_solver=\"mpcg\""),
                                        parse_setting("simulation.tolerance=1e-6"),
                                        parse_setting("simulation.max_linear_iterations=12")});
  CompareWords words;
  words.solvers = "mpcg@1e-2";
  words.integrators = "implicit-euler,bdf2";
  words.time_steps = "10ms,20ms";
  Comparison comparison;
  REQUIRE(compare_integrators(scene, compare_options(words), 0.05, true, comparison));
  REQUIRE(comparison.runs.size() == 6);
  const std::vector<double> coarse = {0.02, 0.02, 0.01}, fine(5, 0.01);
  std::vector<ByHand> expected;
  for (const char* integrator : {"implicit-euler", "bdf2"}) {
    expected.emplace_back(scene, integrator, coarse, tolerance);
    expected.emplace_back(scene, integrator, fine, tolerance);
    expected.emplace_back(scene, integrator, coarse, 1e-2);
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
  CHECK(compare_integrators(scene, options, 0.02, true, comparison));
  REQUIRE(comparison.runs.size() == 2);
  for (const IntegratorRow& row : comparison.runs) {
    CHECK_THAT(row.failure, StartsWith("step "));
    CHECK_FALSE(row.max_distance);
  }
}

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
