// What `drape compare` was asked and what it found, as plain data. docs/compare.md explains the fields.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/words.h"
#include "solver/linear/linear_solver.h"

namespace drape {

struct SolverChoice {
  std::string text;                 // as it was given: NAME or NAME@TOLERANCE
  std::string name;                 // for make_linear_solver
  std::optional<double> tolerance;  // its own; it is judged by the common one all the same
};

struct CompareOptions {
  std::vector<SolverChoice> solvers;
  bool solvers_given = false;
  int steps = 0;  // 0: chosen from the scene
  std::vector<int> at;
  int repeats = 3;
  Names integrators;
  std::vector<double> time_steps;  // s
  std::vector<int> sizes;          // vertices
};

// One solver on one system.
struct SolverRow {
  int vertices = 0, step = 0;
  double time = 0;  // s, at the end of the step
  int constrained = 0;
  std::string solver;
  double tolerance = 0;  // that it was given
  LinearReport report;   // its own words, of the first call at this step
  double residual = 0;   // computed here, relative as LinearOptions::tolerance
  double violation = 0;  // m/s, largest |(I - S) dv - z|
  double first_ms = 0;   // wall time of the first call at this step
  double setup_ms = 0;   // median of the repeats, the solver's word
  double solve_ms = 0;   // median of the repeats, the rest of the wall time
  double total_ms() const { return setup_ms + solve_ms; }
  std::optional<double> peak_bytes;  // of set-up and all solves so far; empty: could not be measured
  bool finite = true;                // all of dv
  std::string failure;               // what the solver threw; empty: nothing
  bool most_accurate = false;
  double difference = 0;          // m/s, largest of a vertex, from the most accurate
  std::optional<double> allowed;  // m/s, the most that the tolerance can explain at this vertex
  int vertex = -1;                // of the cloth, where the difference is largest
  std::string cloth;
  bool agrees = false;
  std::string verdict;
  std::vector<double> history;  // relative residual of every iteration, from 0
};

// reference: it is what the others are compared with. nothing:
// the same to the last bit. not_known: it failed.
enum class DiffersBy { reference, nothing, linear_algebra, time_integration, not_known };
std::string_view name(DiffersBy cause);

// One run of an integrator.
struct IntegratorRow {
  std::string integrator, solver;
  double time_step = 0;  // s
  std::string failure;   // empty: it reached the end
  double end = 0;        // s, how far it came
  int steps = 0, steps_cut = 0, steps_not_converged = 0;
  long linear_iterations = 0, inner_steps = 0, inner_rejected = 0;
  double wall_ms = 0;
  double energy_drift = 0;  // J, kinetic + elastic + gravity, end less start
  bool reference = false;
  std::optional<double> max_distance, rms_distance;  // m, of the vertices from the reference run
  std::optional<double> energy_error;                // J, at the end, less the reference's
  std::optional<double> same_run_distance;  // m, largest, from the same run with the reference solver
  DiffersBy differs_by = DiffersBy::time_integration;
};

// time ~ vertices^a, by least squares over the sizes.
struct Growth {
  std::string solver;
  double time = 0;
  std::optional<double> iterations;  // empty: a direct solver
};

struct Comparison {
  std::string scene, integrator, reference_solver;
  double time_step = 0, tolerance = 0;
  int steps = 0, repeats = 0, threads = 1;
  std::vector<int> at, sizes;
  Names solvers;
  std::vector<SolverRow> rows;
  std::vector<IntegratorRow> runs;
  double run_duration = 0;  // s, of the integrator runs
  std::vector<Growth> growth;
  std::string failure;  // of the path, empty: it reached its last step

  // Every solver agrees, and nothing failed: the path and all runs.
  bool agree() const;
};

// Fitted to the last step of every size; empty with less than two sizes.
std::vector<Growth> growth_of(const Comparison& comparison);

}  // namespace drape
