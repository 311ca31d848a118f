// Every linear solver on the same systems: sheets of 1 k to 400 k vertices hung by two corners (1 m x 1 m,
// 0.2 kg/m^2, stretch 2000 N/m, h = 10 ms), of the step after 60. Tolerances 1e-3 and 1e-6, one thread and
// two; then the same matrix without pins, and with every fifth vertex sliding on a surface.
//   drape_bench_solvers [SIDE ...]      the sheets' sides in vertices; default 32 100 200 316 632
//   fresh: set-up and solve by a new solver;  again: the same solver once more (analysis and hierarchy kept)
//   by hand: CHOLMOD called directly on the projected matrix, made beforehand: what "cholmod" adds to it
#ifdef DRAPE_HAVE_CHOLMOD
#include <cholmod.h>
#endif
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "app/compare/recording_solver.h"
#include "mesh/base/threads.h"
#include "solver/linear/projected.h"
#include "tests/bench/bench.h"

namespace {

using namespace drape;
using namespace drape::app;
using namespace drape::bench;

LinearSystem hung_sheet(int side) {
  Sheet sheet(side, 2000);
  SystemRecording recording{.keep_first = true, .last = {}};
  ImplicitEuler stepper(sheet.system, sheet.constraints,
                        std::make_unique<RecordingSolver>(make_linear_solver("ppcg+multigrid"), recording),
                        {.tolerance = 1e-3});
  for (int k = 0; k < 60; ++k) stepper.advance(sheet.state, 0.01);
  recording.on = true;
  stepper.advance(sheet.state, 0.01);
  return std::move(*recording.last);
}

struct Timing {
  double fresh = 0, again = 0;
  std::optional<LinearReport> report;  // none where only the time was taken
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

// Every fifth vertex may move along a surface only.
Filter sliding(const BlockPattern& pattern) {
  Filter filter;
  for (int i = 0; i < pattern.rows(); i += 5) {
    const Vec3 normal = Vec3(std::sin(0.01 * i), 1, std::cos(0.01 * i)).normalized();
    filter.constrain(i, Mat3::Identity() - normal * normal.transpose(), Vec3::Zero());
  }
  filter.renumber(pattern.row_of());
  return filter;
}

void print(const char* name, const char* what, const LinearSystem& system, double tolerance, const Timing& r,
           double mpcg) {
  char residual[16] = "-";
  if (r.report) std::snprintf(residual, sizeof residual, "%.1e", r.report->residual);
  std::printf("%9d %-8s %7d %9.0e %16s %11s %11.2f %11.2f %9.2f %10s  %s\n", system.A.rows(), what, threads(),
              tolerance, name, r.report ? std::to_string(r.report->iterations).c_str() : "-", r.fresh,
              r.again, r.fresh / mpcg, residual, r.report ? remark(*r.report).c_str() : "");
  std::fflush(stdout);
}

#ifdef DRAPE_HAVE_CHOLMOD
// Factorise and solve, the analysis done before, by calling CHOLMOD directly.
Timing cholmod_by_hand(const LinearSystem& system, int repeats) {
  ProjectedSystem projected;
  projected.project(system.A, system.b, system.filter, system.options);
  const auto& lower = projected.matrix();
  cholmod_common common;
  cholmod_start(&common);
  common.final_ll = 1;
  cholmod_sparse matrix = {};
  matrix.nrow = matrix.ncol = static_cast<std::size_t>(lower.rows());
  matrix.nzmax = static_cast<std::size_t>(lower.nonZeros());
  matrix.p = const_cast<int*>(lower.outerIndexPtr());
  matrix.i = const_cast<int*>(lower.innerIndexPtr());
  matrix.x = const_cast<double*>(lower.valuePtr());
  matrix.stype = -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.sorted = matrix.packed = 1;
  cholmod_dense right = {};
  right.nrow = right.d = right.nzmax = matrix.nrow;
  right.ncol = 1;
  right.x = const_cast<double*>(projected.right_side().data());
  right.xtype = CHOLMOD_REAL;
  Timing timing;
  const double start = now_ms();
  cholmod_factor* factor = cholmod_analyze(&matrix, &common);
  const double analysis = now_ms() - start;
  timing.again = timed(repeats, [&] {
    cholmod_factorize(&matrix, factor, &common);
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, &right, &common);
    cholmod_free_dense(&solution, &common);
  });
  timing.fresh = analysis + timing.again;
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  return timing;
}
#endif

void bench_case(const char* what, const LinearSystem& system, double tolerance) {
  const int vertices = system.A.rows(), repeats = vertices < 50000 ? 5 : vertices < 200000 ? 3 : 1;
  double mpcg = 0;
  for (const LinearSolverInfo& info : linear_solvers()) {
    const bool direct = info.name.starts_with("eigen") || info.name == "cholmod";
    if (info.name == "auto") continue;  // for a single system it is mpcg+block-ic0
    const bool like_mpcg = info.name == "ppcg" || info.name == "ppcg+block-ic0";  // to the digit
    const bool slow = direct || like_mpcg || info.name.starts_with("sundials") || info.name == "petsc";
    if (slow && (vertices > (direct ? 15000 : 50000) || what != std::string("hung"))) continue;
    const Timing r = time_solver(info.name, system, tolerance, repeats);
    if (info.name == "mpcg") mpcg = r.fresh;
    print(std::string(info.name).c_str(), what, system, tolerance, r, mpcg);
#ifdef DRAPE_HAVE_CHOLMOD
    if (info.name == "cholmod")
      print("by hand", what, system, tolerance, cholmod_by_hand(system, repeats), mpcg);
#endif
  }
}

void bench_size(int side) {
  LinearSystem system = hung_sheet(side);
  const int most = threads();
  for (double tolerance : {1e-3, 1e-6})
    for (int t = 1; t <= std::min(most, 2); ++t) {
      if (tolerance < 1e-3 && side > 320) continue;  // minutes
      set_threads(t);
      bench_case("hung", system, tolerance);
    }
  set_threads(1);
  if (side >= 100 && side <= 320) {
    system.filter = {};
    bench_case("no pins", system, 1e-3);
    system.filter = sliding(system.A.pattern());
    bench_case("sliding", system, 1e-3);
  }
  set_threads(most);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sides;
  for (int k = 1; k < argc; ++k) sides.push_back(std::atoi(argv[k]));
  if (sides.empty()) sides = {32, 100, 200, 316, 632};
  std::printf("%9s %-8s %7s %9s %16s %11s %11s %11s %9s %10s\n", "vertices", "case", "threads", "tolerance",
              "solver", "iterations", "fresh ms", "again ms", "x mpcg", "residual");
  for (int side : sides) bench_size(side);
  return 0;
}
