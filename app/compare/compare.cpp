#include "app/compare/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/base/interrupt.h"
#include "app/compare/files.h"
#include "app/compare/hung_sheet.h"
#include "app/compare/integrators.h"
#include "app/compare/solvers.h"
#include "app/compare/tables.h"
#include "app/recording/scene_record.h"
#include "app/simulation/time_loop.h"
#include "mesh/base/errors.h"
#include "mesh/base/threads.h"

namespace drape::app {
namespace {

void say(const CommonOptions& common, const std::string& line) {
  if (!common.quiet) std::fprintf(stderr, "%s\n", one_line(line).c_str());
}

// The first, the middle and the last.
std::vector<int> spread(int steps) {
  std::vector<int> at = {1, (steps + 1) / 2, steps};
  at.erase(std::unique(at.begin(), at.end()), at.end());
  return at;
}

// The steps of the path are those that `drape simulate` takes.
StepGrid grid_of(const Scene& scene) {
  return StepGrid(scene.simulation.time_step, scene.simulation.frame_rate);
}

// Which steps are taken and compared.
void choose_steps(const Scene& scene, CompareOptions& options) {
  constexpr int usual = 50, usual_of_a_sheet = 30;
  if (options.steps == 0 && !options.at.empty()) options.steps = options.at.back();
  if (options.steps == 0 && !options.sizes.empty()) options.steps = usual_of_a_sheet;
  if (options.steps == 0) {
    const double whole = scene.simulation.duration / grid_of(scene).step();
    options.steps = static_cast<int>(std::clamp(std::round(whole), 1.0, static_cast<double>(usual)));
  }
  if (options.at.empty())
    options.at = options.sizes.empty() ? spread(options.steps) : std::vector<int>{options.steps};
}

// Follows one run with the reference solver and hands the systems of the chosen steps to the bench. False
// when the user interrupts; a failed step ends it and is noted.
class Path {
 public:
  Path(const Scene& scene, Simulation& simulation, const CommonOptions& common)
      : scene_(scene), simulation_(simulation), common_(common) {
    const SimulationOptions& wanted = scene.simulation;
    simulation.use([this, &wanted](System& system, Constraints& constraints) {
      return make_integrator(
          wanted.integrator, system, constraints,
          std::make_unique<RecordingSolver>(make_linear_solver(wanted.linear_solver), recording_),
          wanted.step);
    });
  }

  bool follow(const CompareOptions& options, SolverBench& bench, CompareFiles& files,
              Comparison& comparison) {
    const StepGrid grid = grid_of(scene_);
    TimeLoop loop(simulation_, Schedule(grid, 0, grid.time(options.at.back())));
    bool whole = true;
    listen(options, 1);
    march(loop, [&](const StepReport& report) {
      whole = report.done ? bench_step(loop.number(), options, bench, files, comparison)
                          : note_failure(loop.number(), report, comparison);
      listen(options, loop.number() + 1);
      return whole;
    });
    return whole && !interrupted();
  }

 private:
  // Keeps the system of step k where it is one that is compared.
  void listen(const CompareOptions& options, long k) {
    recording_.on = std::find(options.at.begin(), options.at.end(), k) != options.at.end();
    recording_.last.reset();
  }

  // False when the user interrupts.
  bool bench_step(long k, const CompareOptions& options, SolverBench& bench, CompareFiles& files,
                  Comparison& comparison) {
    if (!recording_.on) return true;
    if (!recording_.last)
      throw InputError("integrator '" + scene_.simulation.integrator + "' solves no linear system in step " +
                       std::to_string(k) +
                       ": there is nothing to give to the solvers; choose another with --integrator");
    say(common_, "comparing at step " + std::to_string(k) + " of " + std::to_string(options.at.back()) +
                     ", " + counted(simulation_.state.particles(), "vertex"));
    const int step = static_cast<int>(k);
    if (options.save_systems)
      comparison.systems.push_back(files.save(*recording_.last, comparison, step, simulation_.state.time));
    std::vector<SolverRow> rows = bench.compare(*recording_.last, step, simulation_);
    const bool done = !rows.empty();
    for (SolverRow& row : rows) comparison.rows.push_back(std::move(row));
    return done;
  }

  // The path ends, and what was compared so far counts.
  bool note_failure(long k, const StepReport& report, Comparison& comparison) const {
    comparison.failure = "step " + std::to_string(k) + " of the run with " + scene_.simulation.linear_solver +
                         " failed: " + report.failure.what;
    return true;
  }

  const Scene& scene_;
  Simulation& simulation_;
  const CommonOptions& common_;
  SystemRecording recording_;
};

bool compare_scene(const Scene& scene, Simulation& simulation, const CompareOptions& options,
                   const CommonOptions& common, CompareFiles& files, Comparison& comparison) {
  for (const std::string& message : simulation.messages) say(common, message);
  SolverBench bench(options.solvers, comparison.tolerance, options.repeats);
  if (!Path(scene, simulation, common).follow(options, bench, files, comparison)) return false;
  if (options.integrators.empty()) return true;
  return compare_integrators(
      scene, [&] { return make_simulation(scene); }, options, grid_of(scene).time(options.steps),
      common.quiet, comparison);
}

bool compare_sizes(const Scene& scene, const CompareOptions& options, const CommonOptions& common,
                   CompareFiles& files, Comparison& comparison) {
  for (const int vertices : options.sizes) {
    const int side = sheet_side(vertices);
    comparison.sizes.push_back(side * side);
    Simulation simulation = make_hung_sheet(scene, side);
    SolverBench bench(options.solvers, comparison.tolerance, options.repeats,
                      "sheet of " + std::to_string(side * side) + " vertices, ");
    if (!Path(scene, simulation, common).follow(options, bench, files, comparison)) return false;
    if (!comparison.failure.empty()) break;
    if (!options.integrators.empty() && !compare_integrators(
                                            scene, [&] { return make_hung_sheet(scene, side); }, options,
                                            grid_of(scene).time(options.steps), common.quiet, comparison))
      return false;
  }
  comparison.growth = growth_of(comparison);
  return true;
}

// The scene that is compared: with sizes the hung sheet, solved as the given scene says.
Scene scene_of(const std::filesystem::path& path, const CompareOptions& options,
               const CommonOptions& common) {
  if (path.empty() && options.sizes.empty())
    throw InputError("SCENE is required (or --sizes for a generated sheet); see drape compare --help");
  if (options.sizes.empty()) return read_scene(path, common.settings);
  if (path.empty()) return hung_sheet_scene(common.settings);
  const Scene given = read_scene(path, common.settings);
  Scene sheet = hung_sheet_scene({});
  sheet.label += ", solved as " + given.label + " says";
  sheet.simulation.integrator = given.simulation.integrator;
  sheet.simulation.linear_solver = given.simulation.linear_solver;
  sheet.simulation.step = given.simulation.step;
  sheet.simulation.threads = given.simulation.threads;
  return sheet;
}

// simulation: that of the scene; null where sheets are generated.
Comparison begun(const Scene& scene, const Simulation* simulation, const CompareOptions& options) {
  Comparison comparison;
  comparison.scene = scene.label;
  comparison.integrator = scene.simulation.integrator;
  comparison.reference_solver = scene.simulation.linear_solver;
  comparison.time_step = grid_of(scene).step();
  comparison.time_step_asked = grid_of(scene).asked();
  comparison.tolerance = scene.simulation.step.tolerance;
  comparison.made_of = scene_json(scene, simulation);
  comparison.steps = options.steps;
  comparison.at = options.at;
  comparison.repeats = options.repeats;
  comparison.threads = threads();
  for (const SolverChoice& solver : options.solvers) comparison.solvers.push_back(solver.text);
  return comparison;
}

}  // namespace

int compare(const std::filesystem::path& path, const CompareWords& words, const CommonOptions& common) {
  CompareOptions options = compare_options(words);
  const Scene scene = scene_of(path, options, common);
  choose_steps(scene, options);
  if (options.sizes.empty())
    for (const double h : options.time_steps)
      if (const double end = grid_of(scene).time(options.steps); h > (1 + 1e-9) * end)
        throw InputError("--time-steps " + rounded(h, 4) + " s: is longer than the runs, " + rounded(end, 4) +
                         " s or " + counted(options.steps, "step") + " of the scene; ask for more --steps");
  if (scene.simulation.threads > 0) set_threads(scene.simulation.threads);
  Simulation simulation;
  if (options.sizes.empty()) simulation = make_simulation(scene);
  const std::filesystem::path name = options.sizes.empty() ? path.stem() : "sizes";
  CompareFiles files(common.out.empty() ? std::filesystem::path("out") / "compare" / name : common.out,
                     options.save_systems);
  catch_interrupts();

  Comparison comparison = begun(scene, options.sizes.empty() ? &simulation : nullptr, options);
  const bool ended = options.sizes.empty()
                         ? compare_scene(scene, simulation, options, common, files, comparison)
                         : compare_sizes(scene, options, common, files, comparison);
  if (!ended) {
    say(common, "interrupted: nothing is written");
    return 130;
  }
  files.write(comparison);
  if (!common.quiet) {
    std::fputs(text_of(comparison).c_str(), stdout);
    for (const auto& file : files.written()) std::printf("wrote %s\n", file.c_str());
  }
  if (common.quiet)
    for (const SolverRow& row : comparison.rows)
      if (!row.agrees) std::fprintf(stderr, "error: %s: %s\n", row.solver.c_str(), row.verdict.c_str());
  if (!comparison.failure.empty()) std::fprintf(stderr, "error: %s\n", one_line(comparison.failure).c_str());
  for (const IntegratorRow& run : comparison.runs)
    if (!run.failure.empty()) std::fprintf(stderr, "error: %s\n", one_line(line_of(run, comparison)).c_str());
  return comparison.agree() ? 0 : 1;
}

}  // namespace drape::app
