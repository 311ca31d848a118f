// Every linear solver on the same systems: sheets of 1 k to 400 k vertices hung by two corners (1 m x 1 m,
// 0.2 kg/m^2, stretch 2000 N/m, h = 10 ms), after 60 steps. Tolerances 1e-3 and 1e-6, one thread and two.
//   drape_bench_solvers [SIDE ...]      the sheets' sides in vertices; default 32 100 200 316 632
//   fresh: set-up and solve by a new solver;  again: the same solver once more (analysis and hierarchy kept)
#include <cstdio>
#include <cstdlib>
#include <string>

#include "mesh/threads.h"
#include "tests/bench/bench.h"

namespace {

using namespace drape;
using namespace drape::bench;

struct LinearSystem {
  BlockMatrix A;
  VecX b, guess;
  Filter filter;
  LinearOptions options;
};

// Keeps the last system that it solved.
class Recorder final : public LinearSolver {
 public:
  Recorder(std::unique_ptr<LinearSolver> inner, std::unique_ptr<LinearSystem>& last)
      : inner_(std::move(inner)), last_(last) {}
  std::string_view name() const override { return "recorder"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    last_ = std::make_unique<LinearSystem>(LinearSystem{A, b, dv, filter, options});
    return inner_->solve(A, b, filter, options, dv);
  }

 private:
  std::unique_ptr<LinearSolver> inner_;
  std::unique_ptr<LinearSystem>& last_;
};

std::unique_ptr<LinearSystem> hung_sheet(int side) {
  Sheet sheet(side, 2000);
  std::unique_ptr<LinearSystem> last;
  ImplicitEuler stepper(sheet.system, sheet.constraints,
                        std::make_unique<Recorder>(make_linear_solver("mpcg+block-ic0"), last),
                        {.tolerance = 1e-3});
  for (int k = 0; k < 60; ++k) stepper.advance(sheet.state, 0.01);
  return last;
}

struct Timing {
  double fresh = 0, again = 0;
  LinearReport report;
};

Timing time_solver(std::string_view name, const LinearSystem& system, double tolerance, int repeats) {
  LinearOptions options = system.options;
  options.tolerance = tolerance;
  Timing timing;
  std::vector<double> fresh, again;
  for (int k = 0; k < repeats; ++k) {
    const auto solver = make_linear_solver(name);
    for (std::vector<double>* ms : {&fresh, &again}) {
      VecX dv = system.guess;
      const double start = now_ms();
      timing.report = solver->solve(system.A, system.b, system.filter, options, dv);
      ms->push_back(now_ms() - start);
    }
  }
  timing.fresh = median(fresh);
  timing.again = median(again);
  return timing;
}

void bench_size(int side, double tolerance) {
  const auto system = hung_sheet(side);
  const int vertices = side * side, repeats = vertices < 50000 ? 5 : 3, most = threads();
  for (int t = 1; t <= std::min(most, 2); ++t) {
    set_threads(t);
    double mpcg = 0;
    for (const LinearSolverInfo& info : linear_solvers()) {
      const bool direct = info.name.starts_with("eigen") || info.name == "cholmod";
      const bool slow = direct || info.name.starts_with("sundials") || info.name == "petsc";
      if (vertices > (direct ? 15000 : 50000) && slow) continue;  // minutes, and gigabytes
      const Timing r = time_solver(info.name, *system, tolerance, repeats);
      if (info.name == "mpcg") mpcg = r.fresh;
      std::printf("%9d %7d %9.0e %16s %11d %11.2f %11.2f %9.2f %10.1e  %s\n", vertices, t, tolerance,
                  std::string(info.name).c_str(), r.report.iterations, r.fresh, r.again, r.fresh / mpcg,
                  r.report.residual, r.report.note.c_str());
      std::fflush(stdout);
    }
  }
  set_threads(most);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sides;
  for (int k = 1; k < argc; ++k) sides.push_back(std::atoi(argv[k]));
  if (sides.empty()) sides = {32, 100, 200, 316, 632};
  std::printf("%9s %7s %9s %16s %11s %11s %11s %9s %10s\n", "vertices", "threads", "tolerance", "solver",
              "iterations", "fresh ms", "again ms", "x mpcg", "residual");
  for (int side : sides)
    for (double tolerance : {1e-3, 1e-6}) {
      if (tolerance < 1e-3 && side > 320) continue;  // minutes
      bench_size(side, tolerance);
    }
  return 0;
}
