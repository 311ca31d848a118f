// Timings of the solver on sheets hung by two corners: 1 m x 1 m, 0.2 kg/m^2, stretch 1000 N/m, bend 10 uN.m,
// h = 10 ms, 1e-6. Every figure is the median of several repeats; ratios are taken within this run, in which
// one thread and two take turns.
// Deterministic meshes, no random numbers.
#include <sys/resource.h>

#include <malloc.h>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "mesh/base/parallel.h"
#include "tests/bench/bench.h"

namespace {

using namespace drape;
using namespace drape::bench;

// Bytes the process holds in its heap.
double heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// GB/s of a = b + s c over arrays as large as the matrix it is compared with.
double triad_bandwidth(std::size_t bytes) {
  const auto n = static_cast<int>(std::max<std::size_t>(bytes / 24, 1000));
  VecX a = VecX::Zero(n), b = VecX::Ones(n), c = VecX::Ones(n);
  const double ms = timed(9, [&] {
    parallel_for(chunk_count(n), false, [&](int k) {
      const int begin = k * chunk_size, count = std::min(n, begin + chunk_size) - begin;
      a.segment(begin, count) = b.segment(begin, count) + 3.0 * c.segment(begin, count);
    });
  });
  return 24.0 * n / ms * 1e-6;
}

struct Row {
  int vertices;
  double assemble, solve, rest, newton, iterations, per_iteration, product, product_share, bytes_per_vertex;
};

// One row for every number of threads, which take turns step by step: the machine is equally busy for all.
std::vector<Row> measure_sheet(int side, int steps, double tolerance, const std::vector<int>& thread_counts) {
  const double before = heap_bytes();
  Sheet sheet(side, 1000);
  ImplicitEuler stepper(sheet.system, sheet.constraints, make_linear_solver("mpcg"),
                        {.tolerance = tolerance});
  struct Samples {
    std::vector<double> assemble, solve, rest, iterations, newton, per_iteration, product;
  };
  std::vector<Samples> samples(thread_counts.size());
  const int turns = static_cast<int>(thread_counts.size());
  for (int k = 0; k < steps; ++k) {
    set_threads(thread_counts[k % turns]);
    const StepReport r = stepper.advance(sheet.state, 0.01);
    if (k < steps / 3) continue;  // the fall has begun
    Samples& s = samples[k % turns];
    s.assemble.push_back(r.assemble_ms / r.newton_iterations);
    s.solve.push_back(r.solve_ms);
    s.rest.push_back(r.step_ms - r.assemble_ms - r.solve_ms);
    s.iterations.push_back(r.linear_iterations);
    s.newton.push_back(r.newton_iterations);
    s.per_iteration.push_back(r.solve_ms / std::max(1, r.linear_iterations));
  }
  const double bytes = heap_bytes() - before;
  const BlockMatrix& A = stepper.matrix();
  VecX x = VecX::Ones(3 * A.rows()), y = x;
  for (int k = 0; k < 15 * turns; ++k) {
    set_threads(thread_counts[k % turns]);
    samples[k % turns].product.push_back(timed(3, [&] { A.multiply(x, y); }));
  }
  // Bytes of the whole matrix: what a product that does not use the symmetry would have to read.
  const std::size_t whole =
      76 * (2 * static_cast<std::size_t>(A.pattern().blocks()) - static_cast<std::size_t>(A.rows()));
  std::vector<Row> rows;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    set_threads(thread_counts[t]);
    const Samples& s = samples[t];
    const double product = median(s.product);
    const double bandwidth = (static_cast<double>(whole) + 52.0 * A.rows()) / product * 1e-6;
    rows.push_back({side * side, median(s.assemble), median(s.solve), median(s.rest), median(s.newton),
                    median(s.iterations), median(s.per_iteration), product,
                    bandwidth / triad_bandwidth(whole), bytes / (side * side)});
  }
  return rows;
}

struct Size {
  int side, steps;
  double tolerance = 1e-6;
};

void bench_sheets(const std::vector<Size>& sizes) {
  std::printf(
      "\nSheet hung by two corners, mpcg to 1e-6 (the largest to 1e-3). vs triad: the rate at which the "
      "product goes "
      "through the whole matrix, of\nwhich it reads the upper half, as a share of a triad's bandwidth over "
      "as many bytes\n");
  std::printf("%9s %8s %12s %10s %8s %7s %11s %13s %11s %13s %9s\n", "vertices", "threads", "assemble ms",
              "solve ms", "rest ms", "newton", "iterations", "ms/iteration", "product ms", "vs triad b/w",
              "B/vertex");
  const int most = threads();
  const std::vector<int> thread_counts = most > 1 ? std::vector{1, 2} : std::vector{1};
  for (const auto& [side, steps, tolerance] : sizes) {
    const std::vector<Row> rows = measure_sheet(side, steps, tolerance, thread_counts);
    for (std::size_t t = 0; t < rows.size(); ++t) {
      const Row& r = rows[t];
      std::printf("%9d %8d %12.3f %10.2f %8.3f %7.0f %11.0f %13.4f %11.4f %12.0f%% %9.0f\n", r.vertices,
                  thread_counts[t], r.assemble, r.solve, r.rest, r.newton, r.iterations, r.per_iteration,
                  r.product, 100 * r.product_share, r.bytes_per_vertex);
    }
    if (rows.size() > 1)
      std::printf("%9s %8s assembly %.2f x, product %.2f x, CG iteration %.2f x faster with two threads\n",
                  "", "", rows[0].assemble / rows[1].assemble, rows[0].product / rows[1].product,
                  rows[0].per_iteration / rows[1].per_iteration);
    std::fflush(stdout);
  }
  set_threads(most);
}

void bench_ball() {
  set_threads(1);
  TriangleMesh mesh = grid(31, 31, 1, 1);
  for (Vec3& x : mesh.positions) x.y() += 0.31;
  Fabric fabric;
  fabric.stretch_spring = 200;
  fabric.bend_spring = 2e-7;
  fabric.buckling_clamp = 200;
  fabric.damping = 0.005;
  System system(lumped_mass(mesh, 0.15));
  system.add(noh_jung(mesh, fabric));
  system.add(Gravity{});
  Constraints constraints;
  constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, 0.3}, .friction = 0.3});
  ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"));
  State state = at_rest(mesh);
  std::vector<double> ms, collide, solves;
  for (int k = 0; k < 300; ++k) {
    const StepReport r = stepper.advance(state, 0.01);
    ms.push_back(r.step_ms);
    collide.push_back(r.collide_ms);
    solves.push_back(r.linear_solves);
  }
  std::sort(ms.begin(), ms.end());
  std::printf(
      "\n961 particles dropped on a ball, k_s = 200 N/m, one thread: %.2f ms per step (95 %%: %.2f), contact "
      "%.3f ms\n",
      median(ms), ms[ms.size() * 95 / 100], median(collide));
}

// The cube of data/scenes/soft-plane.toml, 10 x 10 x 10 particles and 12876 springs, falls on a plane and
// comes to lie on it.
void bench_cube() {
  set_threads(1);
  std::printf("\n1000 particles, 12876 springs with damping, fall on a plane, one thread\n");
  std::printf("%18s %8s %10s %10s %12s %10s %11s\n", "", "step ms", "median ms", "95 %", "assemble ms",
              "solve ms", "iterations");
  struct Case {
    const char* integrator;
    double h;
    const char* solver = "mpcg";
  };
  for (const auto& [name, h, solver] :
       {Case{"implicit-euler", 0.01}, Case{"implicit-euler", 0.01, "mpcg+block-ic0"}, Case{"bdf2", 0.01},
        Case{"explicit-euler", 5e-4}, Case{"symplectic-euler", 5e-4}, Case{"midpoint", 5e-4},
        Case{"rk4", 5e-4}}) {
    const Lattice cube = box_lattice({10, 10, 10}, Vec3::Constant(0.1));
    const SoftMaterial material{
        .mass = 100, .young = {}, .structural = 5000, .shear = 5000, .bend = 5000, .damping = 10};
    System system(masses(cube, material));
    system.add(soft_body(cube, material));
    system.add(Gravity{});
    Constraints constraints;
    constraints.add(Obstacle{.shape = Plane{{0, 0, 0}, {0, 1, 0}}, .friction = 0.3});
    State state{0, stacked(cube.positions), VecX::Zero(3000)};
    for (int i = 0; i < 1000; ++i) state.x[3 * i + 1] += 0.55;
    auto stepper = make_integrator(name, system, constraints, make_linear_solver(solver));
    std::vector<double> ms, assemble, solve_ms, iterations;
    const int steps = static_cast<int>(1.5 / h);
    for (int k = 0; k < steps; ++k) {
      const StepReport r = stepper->advance(state, h);
      if (!r.done) std::printf("%18s failed at step %d: %s\n", name, k, r.failure.what.c_str());
      if (!r.done) break;
      ms.push_back(r.step_ms);
      assemble.push_back(r.assemble_ms);
      solve_ms.push_back(r.solve_ms);
      iterations.push_back(r.linear_iterations);
    }
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    std::printf("%18s %8g %10.3f %10.3f %12.3f %10.3f %11.0f\n", name, 1000 * h, median(ms),
                sorted[sorted.size() * 95 / 100], median(assemble), median(solve_ms), median(iterations));
  }
}

void bench_obj() {
  const TriangleMesh mesh = grid(708, 708, 1, 1);
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "drape-bench.obj";
  write_obj(path, mesh, mesh.positions);
  const double ms = timed(3, [&] { read_obj(path); });
  std::printf("\nOBJ of %d triangles: read in %.2f s\n", mesh.triangle_count(), ms / 1000);
  std::filesystem::remove(path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--cube") == 0) {
    bench_cube();
    return 0;
  }
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  std::printf("drape benchmarks; %d threads at most\n", threads());
  if (quick) {
    bench_sheets({{32, 30}, {100, 30}});
    bench_ball();
    bench_cube();
    return 0;
  }
  bench_sheets({{32, 60}, {100, 30}, {200, 18}, {400, 12, 1e-3}});
  set_threads(1);
  bench_ball();
  bench_cube();
  bench_obj();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("\npeak memory of this process: %.0f MB\n", static_cast<double>(usage.ru_maxrss) / 1024);
  return 0;
}
