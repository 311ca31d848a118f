// A woven strip that stands on edge, held at one end, topples sideways at the weight that theory says: lateral
// buckling of a beam under its own weight.                          [Timoshenko & Gere, Theory of Elastic Stability, 6.3]
//   area_density b g L^3 = 12.85 sqrt(B b C),  C = 4 D_66 b the torsional rigidity of a strip b wide
// so that Gamma = area_density g L^3 / B = 12.85 sqrt(4 D_66 / B), which is 18.2 where Poisson's ratio is 0. A
// clamp also keeps the strip from warping, which makes it stiffer by a few per cent where it is 16 times longer
// than wide.
#include <catch2/catch.hpp>
#include <cmath>

#include "solver/forces/woven.h"
#include "solver/integrators/bdf.h"
#include "tests/strips.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

// By which factor a small lean out of the plane of the strip grows in the second 12 s of 24.
double growth(StripMesh kind, double gamma) {
  constexpr double length = 0.2, density = 0.15, g = 9.81;
  const double B = density * g * std::pow(length, 3) / gamma;
  const Fabric fabric{.area_density = density, .stretch = 1e6 * B / (length * length), .bend = B};
  const Strip strip = drape::test::strip(kind, 48, 3, length);
  State state = at_rest(strip.mesh);
  for (int i = 0; i < state.particles(); ++i) {  // on edge
    const Vec3 x = state.x.segment<3>(3 * i);
    const double along = std::max(0.0, x.x() / strip.length - 0.02);  // nothing in the clamp
    state.x.segment<3>(3 * i) = Vec3(x.x(), x.z(), 1e-4 * along * along);
  }
  System system(lumped_mass(strip.mesh, density));
  system.add(woven(strip.mesh, strip.mesh, fabric));
  system.add(gravity({0, -g, 0}));
  Constraints constraints;
  constraints.pin(strip.clamped);
  const auto stepper = make_integrator("implicit-euler", system, constraints,
                                       make_linear_solver("ppcg+multigrid"), {.tolerance = 1e-8});
  const auto lean = [&] {
    double out = 0;
    for (int i : strip.tip) out += state.x[3 * i + 2];
    return std::abs(out);
  };
  double before = 0;
  for (int step = 0; step < 240; ++step) {
    if (step == 120) before = lean();
    REQUIRE(stepper->advance(state, 0.1).done);
  }
  return lean() / before;
}

}  // namespace

TEST_CASE("a strip on edge stands below the weight of lateral buckling and topples above it", "[woven]") {
  const double critical = 12.85 * std::sqrt(2);
  for (StripMesh kind : strip_meshes) {
    CAPTURE(name(kind));
    CHECK(growth(kind, 0.95 * critical) < 0.8);
    CHECK(growth(kind, 1.1 * critical) > 1.5);
  }
}
