// What a fabric makes of the bending rigidity it was given, on every kind of mesh and at three sizes:
// cantilevers against the elastica, by both models of a triangle mesh and by hinges; the rigidity in four
// directions; and strips on edge below and above the weight of lateral buckling. Before it what a step costs:
// a sheet of 1 m hung by two corners, from horizontal, one thread.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/base/threads.h"
#include "solver/drape.h"
#include "tests/bent_wave.h"
#include "tests/lateral_buckling.h"
#include "tests/strips.h"

using namespace drape;
using namespace drape::test;

namespace {

const Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-5};

enum class Model {
  springs,
  woven,
  wrinkling,  // woven with compression = 0.1, as named fabrics have it
  hinges,     // woven with these in place of the plate
  quadratic_hinges
};

std::vector<std::unique_ptr<Force>> forces(const TriangleMesh& mesh, Model model) {
  if (model == Model::springs) return noh_jung(mesh, fabric);
  Fabric other = fabric;
  if (model == Model::wrinkling) other.weave.compression = 0.1;
  if (model == Model::hinges) other.weave.bending = Bending::hinges;
  if (model == Model::quadratic_hinges) other.weave.bending = Bending::quadratic_hinges;
  return woven(mesh, mesh, other, Vec3(Vec3::UnitX()));
}

// Height over width of the strip at rest.
double droop(const Strip& sheet, Model model) {
  System system(masses(sheet.mesh, fabric));
  system.add(forces(sheet.mesh, model));
  system.add(gravity({0, -9.81, 0}));
  Constraints constraints;
  constraints.pin(sheet.clamped);
  const auto stepper = make_integrator("implicit-euler", system, constraints,
                                       make_linear_solver("mpcg+block-ic0"), {.tolerance = 1e-10});
  State state = at_rest(sheet.mesh);
  const double h = 0.1 * std::sqrt(sheet.length);
  for (int step = 0; step < 4000 && (step == 0 || max_speed(state.v) > 1e-8); ++step)
    if (!stepper->advance(state, h).done) return NAN;
  double height = 0, width = 0;
  for (int i : sheet.tip) {
    height -= state.x[3 * i + 1];
    width += state.x[3 * i];
  }
  return height / width;
}

const char* name(Model model) {
  constexpr std::array names = {"noh-jung:", "woven:", "wrinkling:", "hinges:", "quadratic hinges:"};
  return names[static_cast<std::size_t>(model)];
}

void hung_sheet(int side, Model model) {
  const TriangleMesh sheet = equilateral_sheet(side, side, 1.0 / (side - 1));
  System system(masses(sheet, fabric));
  system.add(forces(sheet, model));
  system.add(gravity({0, -9.81, 0}));
  Constraints constraints;
  constraints.pin({0, side - 1});
  const auto stepper = make_integrator("implicit-euler", system, constraints,
                                       make_linear_solver("ppcg+multigrid"), {.tolerance = 1e-4});
  State state = at_rest(sheet);
  constexpr int steps = 40;
  StepReport sum;
  for (int step = 0; step < steps; ++step) {
    const StepReport report = stepper->advance(state, 0.01);
    sum.assemble_ms += report.assemble_ms / steps;
    sum.step_ms += report.step_ms / steps;
    sum.linear_iterations += report.linear_iterations;
  }
  std::printf("%6d vertices, %-17s %7.2f ms a step, %6.2f ms assembly, %5.1f iterations\n",
              sheet.vertex_count(), name(model), sum.step_ms, sum.assemble_ms,
              static_cast<double>(sum.linear_iterations) / steps);
}

void rigidity_in_directions() {
  std::printf("Error of the bending energy of waves of 20 cm along 0 / 22.5 / 45 / 90 degrees, %%\n");
  std::printf("%-26s %6s %34s %34s\n", "mesh", "cells", "woven", "hinges");
  const Vec3 warp = Vec3::UnitX();
  for (StripMesh kind : strip_meshes)
    for (int cells : {20, 40, 80}) {
      const TriangleMesh mesh = wave_sheet(kind, cells);
      std::printf("%-26s %6d ", name(kind), cells);
      for (Model model : {Model::woven, Model::hinges}) {
        std::printf("  ");
        const auto all = forces(mesh, model);
        const auto bending =
            std::ranges::find_if(all, [](const auto& force) { return force->name() == "bend"; });
        if (bending == all.end()) continue;
        for (double degrees : {0.0, 22.5, 45.0, 90.0})
          std::printf(" %7.2f", 100 * wave_energy_error(mesh, **bending, plate_of(fabric), warp,
                                                        degrees * M_PI / 180, 0.2));
      }
      std::printf("\n");
    }
}

void strips_on_edge() {
  std::printf("A strip on edge, its Gamma over that of lateral buckling: growth of a lean in 12 s\n");
  for (StripMesh kind : strip_meshes)
    for (int cells : {32, 48, 64}) {
      std::printf("%-26s %6d", name(kind), cells);
      for (double share : {0.95, 1.1})
        std::printf("    %.2f: %8.3g", share, lean_growth(kind, share * critical_gamma, cells));
      std::printf("\n");
    }
}

}  // namespace

int main() {
  set_threads(1);
  for (int side : {32, 71, 101})
    for (Model model : {Model::springs, Model::woven, Model::hinges, Model::quadratic_hinges})
      hung_sheet(side, model);
  rigidity_in_directions();
  strips_on_edge();
  // Gamma = area_density g L^3 / B and H/W: rows of data/reference/cantilever_master.csv.
  constexpr std::pair<double, double> curve[] = {
      {0.01, 0.00124999955}, {1, 0.124561766}, {10, 1.06680232}, {100, 5.88810462}, {1000, 21.3354405}};
  std::printf("Error of H/W of a cantilever, %%: %g kg/m^2, Y = %g N/m, B = %g N m\n", fabric.area_density,
              fabric.stretch, fabric.bend);
  std::printf("%-26s %8s %6s %10s %10s %16s %10s %10s\n", "mesh", "Gamma", "cells", "noh-jung", "woven",
              "compression 0.1", "hinges", "quadratic");
  for (const auto& [gamma, expected] : curve)
    for (StripMesh kind : strip_meshes)
      for (int cells : {10, 20, 40}) {
        const double length = std::cbrt(gamma * fabric.bend / (fabric.area_density * 9.81));
        const Strip sheet = strip(kind, cells, cells < 40 ? 4 : 8, length);
        const auto error = [&, wanted = expected](Model model) {
          return 100 * (droop(sheet, model) / wanted - 1);
        };
        // Stiff strips of springs lie within the dead zone of their clamp: they hang like chains.
        const double springs = gamma < 10 ? NAN : error(Model::springs);
        std::printf("%-26s %8g %6d %10.1f %10.2f %16.2f %10.2f %10.2f\n", name(kind), gamma, cells, springs,
                    error(Model::woven), error(Model::wrinkling), error(Model::hinges),
                    error(Model::quadratic_hinges));
        std::fflush(stdout);
      }
  return 0;
}
