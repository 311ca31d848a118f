// A woven strip that stands on edge, held at one end, topples sideways at the weight that theory says:
// lateral buckling of a beam under its own weight.      [Timoshenko & Gere, Theory of Elastic Stability, 6.3]
//   area_density b g L^3 = 12.85 sqrt(B b C),  C = 4 D_66 b the torsional rigidity of a strip b wide
// so that Gamma = area_density g L^3 / B = 12.85 sqrt(4 D_66 / B), which is 18.2 where Poisson's ratio is 0.
// A clamp also keeps the strip from warping, which makes it stiffer by a few per cent where it is 16 times
// longer than wide.
#pragma once

#include <algorithm>
#include <cmath>

#include "constraints/constraints.h"
#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/fabric.h"
#include "solver/forces/woven.h"
#include "solver/integrators/integrator.h"
#include "solver/linear/linear_solver.h"
#include "solver/system/system.h"
#include "tests/strips.h"

namespace drape::test {

inline const double critical_gamma = 12.85 * std::sqrt(2);

// By which factor a small lean out of the plane of the strip grows in the second 12 s of 24; NaN: a step
// failed. The strip has about `cells` cells along its length, and a sixteenth of them across.
inline double lean_growth(StripMesh kind, double gamma, int cells) {
  constexpr double length = 0.2, density = 0.15, g = 9.81;
  const double B = density * g * std::pow(length, 3) / gamma;
  const Fabric fabric{.area_density = density, .stretch = 1e6 * B / (length * length), .bend = B};
  const Strip on_edge = strip(kind, cells, cells / 16, length);
  State state = at_rest(on_edge.mesh);
  for (int i = 0; i < state.particles(); ++i) {
    const Vec3 x = state.x.segment<3>(3 * i);
    const double along = std::max(0.0, x.x() / on_edge.length - 0.02);  // nothing in the clamp
    state.x.segment<3>(3 * i) = Vec3(x.x(), x.z(), 1e-4 * along * along);
  }
  System system(lumped_mass(on_edge.mesh, density));
  system.add(woven(on_edge.mesh, on_edge.mesh, fabric));
  system.add(gravity({0, -g, 0}));
  Constraints constraints;
  constraints.pin(on_edge.clamped);
  const auto stepper = make_integrator("implicit-euler", system, constraints,
                                       make_linear_solver("ppcg+multigrid"), {.tolerance = 1e-8});
  const auto lean = [&] {
    double out = 0;
    for (int i : on_edge.tip) out += state.x[3 * i + 2];
    return std::abs(out);
  };
  double before = 0;
  for (int step = 0; step < 240; ++step) {
    if (step == 120) before = lean();
    if (!stepper->advance(state, 0.1).done) return NAN;
  }
  return lean() / before;
}

}  // namespace drape::test
