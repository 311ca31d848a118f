// The solvers of drape compare: systems taken out of a run, verdicts, what a row holds, peak memory.
#include <Eigen/Dense>

#include "app/base/peak_memory.h"
#include "app/compare/hung_sheet.h"
#include "app/compare/solvers.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

// A hung sheet whose steps are recorded.
struct Recorded {
  explicit Recorded(const Scene& scene, Simulation made) : simulation(std::move(made)) {
    simulation.integrator = make_integrator(
        "implicit-euler", *simulation.system, *simulation.constraints,
        std::make_unique<RecordingSolver>(make_linear_solver(scene.simulation.linear_solver), recording),
        scene.simulation.step);
  }
  SystemRecording recording;
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
      Contains(
          "mpcg: agree\neigen-ldlt: agree\nmpcg@1e-2: differ: sheet of 400 vertices, step 6, residual ") &&
          Contains(", asked 1e-06; vertex ") && Contains(" of cloth 'sheet', by "));
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
  upper.embedding = Embedding::each(0, 1), lower.embedding = Embedding::each(1, 35);
  upper.end_particle = lower.first_particle = 1;
  lower.end_particle = 36;
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
  const int particle = pattern.particle_of()[worst];
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
    if (allowed && !meets)  // and the reason is told first, the difference as what it is
      CHECK_THAT(row.verdict, StartsWith("differ: step 8, residual ") &&
                                  Contains("; the difference is largest at vertex "));
  }
  CHECK(missed > 0);

  VecX off = best;
  off.segment<3>(0) += Vec3(0, 0.25, 0);  // of a locked one
  CHECK(constraint_violation(system, off) == Approx(0.25));
  off[3 * system.filter.entries().front().particle] = std::nan("");
  CHECK_FALSE(constraint_violation(system, off) <= 1e300);
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
