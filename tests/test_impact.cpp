// Cloth that hits a body: what one linear solve leaves of a motion that bends far in a step is energy that
// nothing brought.
#include <algorithm>
#include <catch2/catch.hpp>

#include "solver/assembly/assembly.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

// Of a sheet that flies into a ball at 2 m/s, as shares of its kinetic energy there.
struct Impact {
  double stored = 0;  // the most that it stored
  double risen = 0;   // the most that all of its energy rose above what it had been
};

Impact impact(ClothModel model, Kind kind, int n, double tilt) {
  Assembly all({0, -9.81, 0});
  all.constraints->add({.shape = Sphere{Vec3::Zero(), 0.1}, .friction = 0.3});
  const Vec3 off(0.02, tilt > 0 ? 0.22 : 0.11, 0.01);
  TriangleMesh mesh = bent(n, kind, 0.4, [](double, double) { return 0.0; });
  const Mat3 turn = Eigen::AngleAxisd(tilt, Vec3(1, 0, 0.3).normalized()).toRotationMatrix();
  for (Vec3& x : mesh.positions) x = turn * x + off;
  all.add({.mesh = mesh, .fabric = {.area_density = 0.15, .stretch = 500, .bend = 1e-5}, .model = model});
  StepOptions options;
  options.tolerance = 1e-4;
  all.use("implicit-euler", "mpcg+block-ic0", options);
  for (int i = 0; i < all.state.particles(); ++i) all.state.v.segment<3>(3 * i) = Vec3(0, -2, 0);
  const double brought = all.system->kinetic_energy(all.state.v);
  double least = all.system->total_energy(all.state);
  Impact found;
  for (int step = 0; step < 15; ++step) {
    const StepReport report = all.advance(0.01);
    REQUIRE(report.done);
    const double stored = all.system->stored_energy(all.state.x),
                 energy = all.system->total_energy(all.state);
    least = std::min(least, energy);
    found.stored = std::max(found.stored, stored / brought);
    found.risen = std::max(found.risen, (energy - least) / brought);
  }
  return found;
}

}  // namespace

TEST_CASE("cloth that hits a ball makes no energy to speak of, of springs as much as it brought",
          "[integrators]") {
  for (const ClothModel model : {ClothModel::woven, ClothModel::noh_jung})
    for (const Kind kind : kinds)
      for (const int n : {12, 20, 28})
        for (const double tilt : {0.0, 0.6}) {
          const Impact found = impact(model, kind, n, tilt);
          INFO(n << " x " << n << " of kind " << static_cast<int>(kind) << ", tilted by " << tilt
                 << (model == ClothModel::woven ? ", woven" : ", springs"));
          CHECK(found.risen < (model == ClothModel::woven ? 0.1 : 1.2));
          CHECK(found.stored < (model == ClothModel::woven ? 1.2 : 2));
        }
}
