// What `drape compare` was asked for and what it found, as plain data. docs/compare.md explains the fields.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/base/words.h"
#include "solver/linear/linear_solver.h"

namespace drape::app {

struct SolverChoice {
  std::string text;  // as it was given, NAME or NAME@TOLERANCE
  std::string name;  // for make_linear_solver
  // Its own tolerance, if it has one. It is judged by the common tolerance all the same.
  std::optional<double> tolerance;
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
  bool save_systems = false;       // the systems of the compared steps are written, too
};

// The result of one solver on one system.
struct SolverRow {
  int vertices = 0, step = 0;
  double time = 0;  // s, at the end of the step
  int constrained = 0;
  std::string solver;
  double tolerance = 0;  // the tolerance that the solver was given
  LinearReport report;   // the solver's own report of the first call at this step
  double residual = 0;   // computed here; relative, as LinearOptions::tolerance
  double violation = 0;  // m/s, largest |(I - S) dv - z|
  double first_ms = 0;   // wall time of the first call at this step
  double setup_ms = 0;   // median of the repeats, as the solver reports it
  double solve_ms = 0;   // median of the repeats: the rest of the wall time
  double total_ms() const { return setup_ms + solve_ms; }
  // Of set-up and all solves so far; empty when it could not be measured.
  std::optional<double> peak_bytes;
  bool finite = true;   // whether all numbers of dv are finite
  std::string failure;  // what the solver threw; else empty
  bool most_accurate = false;
  double difference = 0;          // m/s, the largest difference of a vertex to the most accurate solver
  std::optional<double> allowed;  // m/s, the largest difference that the tolerance can explain at this vertex
  int vertex = -1;                // vertex of the cloth where the difference is largest
  std::string cloth;
  bool agrees = false;
  std::string verdict;
  std::vector<double> history;  // relative residual after every iteration, from 0
};

// How a run differs from the others. reference: the others are compared with this run. nothing: it is equal
// to the last bit. not_known: it failed.
enum class DiffersBy { reference, nothing, linear_algebra, time_integration, not_known };
std::string_view name(DiffersBy cause);

// The result of one run of an integrator.
struct IntegratorRow {
  std::string integrator, solver;
  int vertices = 0;      // of all cloths
  double time_step = 0;  // s
  std::string failure;   // empty when the run reached its end
  double end = 0;        // s, the time that it reached
  int steps = 0, steps_cut = 0, steps_not_converged = 0;
  long linear_iterations = 0, inner_steps = 0, inner_rejected = 0;
  double wall_ms = 0;
  double energy_drift = 0;  // J, kinetic + elastic + gravity energy at the end, minus the start
  bool reference = false;
  std::optional<double> max_distance, rms_distance;  // m, distance of the vertices from the reference run
  std::optional<double> energy_error;                // J, energy at the end minus that of the reference run
  std::optional<double> strain, strain_error;        // largest of an edge at the end; less the reference's
  std::optional<double> same_run_distance;  // m, largest distance from the same run with the reference solver
  DiffersBy differs_by = DiffersBy::time_integration;
};

// Exponents a in time ~ vertices^a, and the same for iterations, fitted over the sizes by least squares.
struct Growth {
  std::string solver;
  double time = 0;
  std::optional<double> iterations;  // empty for a direct solver
};

struct Comparison {
  std::string scene, integrator, reference_solver;
  double time_step = 0, time_step_asked = 0, tolerance = 0;
  Json::Members made_of = {};  // cloths, bodies and settings of the scene: app/recording/scene_record.h
  int steps = 0, repeats = 0, threads = 1;
  std::vector<int> at, sizes;
  Names solvers;
  std::vector<SolverRow> rows;
  std::vector<IntegratorRow> runs;
  double run_duration = 0;  // s, duration of the integrator runs
  std::vector<Growth> growth;
  Names systems;        // the folders of the systems that were saved, within the output folder
  std::string failure;  // of the run that gives the systems; empty when it reached its last step

  // True when every solver agrees and nothing failed, neither the run that gives the systems nor an
  // integrator's.
  bool agree() const;
};

// Fitted to the last step of every size; empty when there are fewer than two sizes.
std::vector<Growth> growth_of(const Comparison& comparison);

}  // namespace drape::app
