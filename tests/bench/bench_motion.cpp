// Whole runs in motion: what a simulated second costs, and where its time goes.
//   hung      a sheet of 1 m that begins horizontal and swings down from two of its corners
//   dropped   the same sheet, let go 1 cm (or --height, in m) above a ball of 0.3 m radius, friction 0.3
// 0.2 kg/m^2, 1000 N/m, 10 uN.m, h = 10 ms, tolerance 1e-4. Iterations, solves and Newton iterations are
// those of a step on average; the contact residual is the largest of the run. Arguments: SIDE ... (vertices
// along an edge; 32 and 100 unless given), --steps N (100), --solver NAME (auto), --threads N, --model
// noh-jung|woven, --scene hung|dropped,
// --self-contact 1 (the sheet meets itself, thickness 1 mm), --alone 1 (tells what the last system of each step takes
// alone, as if the contacts were known before). It ends with the times as a table in Markdown, for
// docs/measured.md; each cell has a number for every number of threads.
// Without a model, a scene or a number of threads each of them is measured in turn.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "mesh/base/threads.h"
#include "solver/drape.h"
#include "solver/forces/self_contact_force.h"
#include "tests/bench/bench.h"

namespace {

using namespace drape;
using namespace drape::bench;

struct Run {
  int side, threads;
  std::string scene, model, solver;
  bool self_contact = false, alone = false;
  double height = 0.01;  // m above the ball
};

// Remembers the last system of a step, to solve it alone.
class LastSystem final : public LinearSolver {
 public:
  explicit LastSystem(const std::string& name) : solver_(make_linear_solver(name)) {}
  std::string_view name() const override { return solver_->name(); }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    if (first_) guess_ = dv;
    first_ = false;
    b_ = b;
    filter_ = filter;
    options_ = options;
    return solver_->solve(A, b, filter, options, dv);
  }
  void begin_step() { first_ = true; }

  // The iterations that it takes from the first guess of the step, or from zero.
  int iterations(const BlockMatrix& A, std::string_view method, bool from_guess, double tolerance) const {
    VecX dv = from_guess ? guess_ : VecX(VecX::Zero(b_.size()));
    LinearOptions options = options_;
    options.tolerance = tolerance;
    return make_linear_solver(method)->solve(A, b_, filter_, options, dv).iterations;
  }

 private:
  std::unique_ptr<LinearSolver> solver_;
  bool first_ = true;
  VecX guess_, b_;
  Filter filter_;
  LinearOptions options_;
};

struct Cost {
  double seconds = 0;  // for a simulated second
  double iterations = 0, solves = 0, newton = 0, most_iterations = 0;
  double assemble = 0, solve = 0, collide = 0;  // shares of the time of a step
  double contact_residual = 0;                  // the largest of the run
  int not_converged = 0, by_multigrid = 0;
  // Iterations of the last system of a step alone: by method, from the step's first guess and from zero.
  double alone[2][2] = {};
};
constexpr const char* methods_alone[2] = {"mpcg+block-ic0", "ppcg+multigrid"};

Cost measure(const Run& run, int steps) {
  set_threads(run.threads);
  TriangleMesh sheet = grid(run.side, run.side, 1, 1);
  const bool dropped = run.scene == "dropped";
  if (dropped)
    for (Vec3& x : sheet.positions) x.y() += 0.3 + run.height;
  const Fabric fabric{.area_density = 0.2, .stretch = 1000, .bend = 1e-5};
  System system(lumped_mass(sheet, fabric.area_density));
  system.add(run.model == "woven" ? woven(sheet, sheet, fabric) : noh_jung(sheet, fabric));
  system.add(Gravity{});
  Constraints constraints;
  if (dropped)
    constraints.add(Obstacle{.shape = Sphere{Vec3::Zero(), 0.3}, .friction = 0.3});
  else
    constraints.pin({0, run.side - 1});
  if (run.self_contact) {
    std::vector<SelfFace> faces;
    for (const Triangle& t : sheet.triangles) faces.push_back({t, 1e-3, 0.3});
    constraints.add_self_faces(faces);
    system.add(self_contact_force(constraints));
  }
  auto solver = std::make_unique<LastSystem>(run.solver);
  LastSystem& last = *solver;
  ImplicitEuler stepper(system, constraints, std::move(solver), {.tolerance = 1e-4});
  State state = at_rest(sheet);
  StepReport sum;
  Cost cost;
  sum.step_ms = 0;
  for (int k = 0; k < steps; ++k) {
    last.begin_step();
    const StepReport r = stepper.advance(state, 0.01);
    for (int m = 0; m < 2 && run.alone; ++m)
      for (int guess = 0; guess < 2; ++guess)
        cost.alone[m][guess] +=
            1.0 / steps * last.iterations(stepper.matrix(), methods_alone[m], guess == 0, 1e-4);
    sum.step_ms += r.step_ms;
    sum.assemble_ms += r.assemble_ms;
    sum.solve_ms += r.solve_ms;
    sum.collide_ms += r.collide_ms;
    cost.iterations += static_cast<double>(r.linear_iterations) / steps;
    cost.solves += static_cast<double>(r.linear_solves) / steps;
    cost.newton += static_cast<double>(r.newton_iterations) / steps;
    cost.most_iterations = std::max(cost.most_iterations, static_cast<double>(r.linear_iterations));
    cost.not_converged += !r.converged;
    cost.contact_residual = std::max(cost.contact_residual, r.contact_residual);
    cost.by_multigrid += r.multigrid_solves;
    if (!r.done) std::printf("step %d is not done: %s\n", k, r.failure.what.c_str());
  }
  cost.seconds = sum.step_ms / steps / 10;
  cost.assemble = sum.assemble_ms / sum.step_ms;
  cost.solve = sum.solve_ms / sum.step_ms;
  cost.collide = sum.collide_ms / sum.step_ms;
  return cost;
}

// Seconds for a simulated second: a row for a scene and model, a column for a size.
class Table {
 public:
  void add(const Run& run, double seconds) {
    if (rows_.empty() || rows_.back().scene != run.scene || rows_.back().model != run.model)
      rows_.push_back({run.scene, run.model, {}});
    std::string& cell = rows_.back().cells[run.side * run.side];
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", seconds);
    cell += (cell.empty() ? "" : " / ") + std::string(text);
  }
  void print(const std::vector<int>& sides) const {
    std::printf("\nSeconds for a simulated second, by vertices\n\n| | model |");
    for (int side : sides) std::printf(" %d |", side * side);
    std::printf("\n| --- | --- |");
    for (std::size_t k = 0; k < sides.size(); ++k) std::printf(" --- |");
    for (const Row& row : rows_) {
      std::printf("\n| %s | `%s` |", row.scene.c_str(), row.model.c_str());
      for (int side : sides) std::printf(" %s |", row.cells.at(side * side).c_str());
    }
    std::printf("\n");
  }

 private:
  struct Row {
    std::string scene, model;
    std::map<int, std::string> cells;  // by vertices
  };
  std::vector<Row> rows_;
};

}  // namespace

int main(int count, char** arguments) {
  std::vector<int> sides, thread_counts = {1, 2};
  std::vector<std::string> scenes = {"hung", "dropped"}, models = {"noh-jung", "woven"};
  std::string solver = "auto";
  int steps = 100;
  bool self_contact = false, alone = false;
  double height = 0.01;
  for (int k = 1; k < count; ++k) {
    const std::string name = arguments[k];
    if (name.rfind("--", 0) != 0) {
      sides.push_back(std::atoi(arguments[k]));
      continue;
    }
    const char* const value = k + 1 < count ? arguments[++k] : nullptr;
    if (value && name == "--steps")
      steps = std::atoi(value);
    else if (value && name == "--solver")
      solver = value;
    else if (value && name == "--threads")
      thread_counts = {std::atoi(value)};
    else if (value && name == "--model")
      models = {value};
    else if (value && name == "--scene")
      scenes = {value};
    else if (value && name == "--height")
      height = std::atof(value);
    else if (value && name == "--alone")
      alone = std::atoi(value) != 0;
    else if (value && name == "--self-contact")
      self_contact = std::atoi(value) != 0;
    else
      return std::fprintf(stderr,
                          "usage: drape_bench_motion [SIDE ...] [--steps N] [--solver NAME] [--threads N] "
                          "[--model NAME] "
                          "[--scene hung|dropped] [--height METRES] [--alone 0|1] [--self-contact 0|1]\n"),
             2;
  }
  if (sides.empty()) sides = {32, 100};
  std::printf("%s, %d steps\n", solver.c_str(), steps);
  std::printf("%-8s %-9s %8s %7s %10s %8s %11s %6s %7s %7s %9s %9s %6s %8s %9s %9s\n", "scene", "model",
              "vertices", "threads", "s a second", "exponent", "iterations", "most", "solves", "newton",
              "multigrid", "assembly", "solve", "contact", "residual", "unsettled");
  Table table;
  for (const std::string& scene : scenes)
    for (const std::string& model : models) {
      std::map<int, double> before;  // threads -> s a simulated second, of the smaller sheet
      for (std::size_t s = 0; s < sides.size(); ++s)
        for (int threads : thread_counts) {
          const Run run{sides[s], threads, scene, model, solver, self_contact, alone, height};
          const Cost c = measure(run, steps);
          table.add(run, c.seconds);
          const double growth =
              s == 0 ? NAN
                     : std::log(c.seconds / before[threads]) / (2 * std::log(1.0 * sides[s] / sides[s - 1]));
          before[threads] = c.seconds;
          std::printf(
              "%-8s %-9s %8d %7d %10.2f %8.2f %11.1f %6.0f %7.1f %7.2f %8.0f%% %8.0f%% %5.0f%% %7.0f%% %9.1e "
              "%9d\n",
              scene.c_str(), model.c_str(), sides[s] * sides[s], threads, c.seconds, growth, c.iterations,
              c.most_iterations, c.solves, c.newton, 100 * c.by_multigrid / (c.solves * steps),
              100 * c.assemble, 100 * c.solve, 100 * c.collide, c.contact_residual, c.not_converged);
          for (int m = 0; m < 2 && alone; ++m)
            std::printf(
                "  the last system alone, %s: %.1f iterations from the guess of the step, %.1f from zero\n",
                methods_alone[m], c.alone[m][0], c.alone[m][1]);
          std::fflush(stdout);
        }
    }
  table.print(sides);
  return 0;
}
