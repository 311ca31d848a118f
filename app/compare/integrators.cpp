#include "app/compare/integrators.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/base/interrupt.h"
#include "app/simulation/time_loop.h"
#include "mesh/base/stopwatch.h"

namespace drape::app {
namespace {

struct Run {
  IntegratorRow row;
  VecX x;  // m, at the end; empty when it did not get there
  double end_energy = 0;
};

// What a step adds; false when the run ends with it.
bool count(const StepReport& report, IntegratorRow& row) {
  if (!report.done) {
    row.failure = "step " + std::to_string(row.steps + 1) + ": " + one_line(report.failure.what);
    return false;
  }
  ++row.steps;
  row.steps_cut += report.substeps > 1 ? 1 : 0;
  row.steps_not_converged += report.converged ? 0 : 1;
  row.linear_iterations += report.linear_iterations;
  row.inner_steps += report.inner_steps;
  row.inner_rejected += report.inner_rejected;
  return true;
}

// m, of all vertices of the start: particles may become one or part on the way, in one run sooner than in
// another.
VecX vertices_of(const Simulation& simulation) {
  std::vector<Vec3> all;
  for (const Cloth& cloth : simulation.cloths) {
    std::vector<Vec3> x = cloth.embedding.positions(simulation.state.x);
    if (cloth.tearing) x.resize(x.size() - cloth.tearing->copy_of.size());
    all.insert(all.end(), x.begin(), x.end());
  }
  return stacked(all);
}

Run run_one(const Scene& scene, const MakeSimulation& make, const std::string& integrator, double h,
            const SolverChoice& solver, double duration) {
  Run run;
  run.row.integrator = integrator;
  run.row.solver = solver.text;
  run.row.time_step = h;
  try {
    Simulation simulation = make();
    run.row.vertices = static_cast<int>(vertices_of(simulation).size() / 3);
    StepOptions options = scene.simulation.step;
    if (solver.tolerance) options.tolerance = *solver.tolerance;
    simulation.use([&](System& system, Constraints& constraints) {
      return make_integrator(integrator, system, constraints, make_linear_solver(solver.name), options);
    });
    const double start = simulation.system->total_energy(simulation.state);
    TimeLoop loop(simulation, Schedule(StepGrid(h), 0, duration));  // no frames: steps as they were asked for
    {
      const Stopwatch watch(run.row.wall_ms);
      march(loop, [&](const StepReport& report) { return count(report, run.row); });
    }
    run.row.end = simulation.state.time;
    run.end_energy = simulation.system->total_energy(simulation.state);
    run.row.energy_drift = run.end_energy - start;
    if (run.row.failure.empty()) {
      run.x = vertices_of(simulation);
      run.row.strain = largest_strain(simulation.cloths, simulation.state.x);
    }
  } catch (const std::exception& error) {  // a row, and the others go on
    run.row.failure = one_line(error.what());
  }
  return run;
}

struct Distance {
  double max = 0, rms = 0;
};

Distance distance(const VecX& a, const VecX& b) {
  Distance d;
  for (Eigen::Index i = 0; i + 2 < a.size(); i += 3) {
    const double squared = (a.segment<3>(i) - b.segment<3>(i)).squaredNorm();
    d.max = std::max(d.max, squared);
    d.rms += squared;
  }
  return {std::sqrt(d.max), std::sqrt(d.rms / std::max(1.0, static_cast<double>(a.size()) / 3))};
}

std::vector<double> time_steps(const Scene& scene, const CompareOptions& options) {
  const double h = StepGrid(scene.simulation.time_step, scene.simulation.frame_rate).step();
  return options.time_steps.empty() ? std::vector<double>{h, h / 2, h / 4} : options.time_steps;
}

// The finest finished run with the reference solver, of the first integrator that has one.
const Run* reference_of(const std::vector<Run>& runs, const CompareOptions& options,
                        const std::string& solver) {
  for (const std::string& integrator : options.integrators) {
    const Run* finest = nullptr;
    for (const Run& run : runs)
      if (run.row.integrator == integrator && run.row.solver == solver && run.x.size() > 0 &&
          (!finest || run.row.time_step < finest->row.time_step))
        finest = &run;
    if (finest) return finest;
  }
  return nullptr;
}

// What a run lies off by; solver: the reference's.
DiffersBy cause_of(const IntegratorRow& row, const std::string& solver) {
  if (!row.failure.empty()) return DiffersBy::not_known;
  if (row.reference) return DiffersBy::reference;
  const bool same_solver = row.solver == solver;
  if ((same_solver ? row.max_distance : row.same_run_distance) == 0) return DiffersBy::nothing;
  return same_solver ? DiffersBy::time_integration : DiffersBy::linear_algebra;
}

void measure_distances(std::vector<Run>& runs, const CompareOptions& options, const std::string& solver) {
  const Run* const reference = reference_of(runs, options, solver);
  for (Run& run : runs) {
    run.row.reference = &run == reference;
    if (run.x.size() == 0 || !reference) continue;
    const Distance d = distance(run.x, reference->x);
    run.row.max_distance = d.max;
    run.row.rms_distance = d.rms;
    run.row.energy_error = run.end_energy - reference->end_energy;
    run.row.strain_error = *run.row.strain - *reference->row.strain;
    for (const Run& other : runs)
      if (run.row.solver != solver && other.row.solver == solver && other.x.size() > 0 &&
          other.row.integrator == run.row.integrator && other.row.time_step == run.row.time_step)
        run.row.same_run_distance = distance(run.x, other.x).max;
  }
  for (Run& run : runs) run.row.differs_by = cause_of(run.row, solver);
}

}  // namespace

bool compare_integrators(const Scene& scene, const MakeSimulation& make, const CompareOptions& options,
                         double duration, bool quiet, Comparison& comparison) {
  const std::string& reference = scene.simulation.linear_solver;
  const SolverChoice reference_choice{reference, reference, {}};
  std::vector<Run> runs;
  const auto add = [&](const std::string& integrator, double h, const SolverChoice& solver) {
    if (!quiet)
      std::fprintf(stderr, "running %s at %s s with %s\n", integrator.c_str(), rounded(h, 4).c_str(),
                   solver.text.c_str());
    runs.push_back(run_one(scene, make, integrator, h, solver, duration));
    return !interrupted();
  };
  const std::vector<double> steps = time_steps(scene, options);
  for (const std::string& integrator : options.integrators) {
    for (const double h : steps)
      if (!add(integrator, h, reference_choice)) return false;
    for (const SolverChoice& solver : options.solvers)
      if (solver.text != reference && !add(integrator, steps.front(), solver)) return false;
  }
  measure_distances(runs, options, reference);
  comparison.run_duration = duration;
  for (Run& run : runs) comparison.runs.push_back(std::move(run.row));
  return true;
}

}  // namespace drape::app
