#include "app/textile/rig.h"

#include <cmath>

#include "app/base/interrupt.h"
#include "mesh/base/errors.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/woven.h"
#include "solver/system/measure.h"

namespace drape::app {
namespace {

std::vector<std::unique_ptr<Force>> forces_of(const TriangleMesh& mesh, const Cut& cut) {
  switch (cut.model) {
    case ClothModel::noh_jung:
      return noh_jung(mesh, cut.fabric);
    case ClothModel::woven:
      return woven(mesh, mesh, cut.fabric, Vec3(std::cos(cut.angle), 0, std::sin(cut.angle)));
    case ClothModel::choi_ko:
      break;
  }
  throw InputError("model choi-ko needs a grid of quads, and a specimen is an irregular mesh of triangles");
}

// Those of the model: neighbour weighting is part of them.
std::vector<double> masses_of(const TriangleMesh& mesh, const Cut& cut) {
  return cut.model == ClothModel::noh_jung ? masses(mesh, cut.fabric)
                                           : lumped_mass(mesh, cut.fabric.area_density);
}

}  // namespace

Rig::Rig(const Specimen& specimen, const Cut& cut, const Vec3& g,
         const std::function<Vec3(const Vec3&)>& start)
    : system_(masses_of(specimen.mesh, cut)), state_(at_rest(specimen.mesh)) {
  system_.add(forces_of(specimen.mesh, cut));
  system_.add(gravity(g));
  for (int i = 0; i < specimen.mesh.vertex_count(); ++i)
    state_.x.segment<3>(3 * i) = start(specimen.mesh.positions[static_cast<std::size_t>(i)]);
  constraints_.pin(specimen.held);
  constraints_.pin(specimen.moved);
  integrator_ = make_integrator("implicit-euler", system_, constraints_, make_linear_solver("ppcg+block-ic0"),
                                {.tolerance = 1e-8});
}

bool Rig::settle(double h, double speed, int most) {
  for (int k = 0; k < most; ++k) {
    if (interrupted() || !step(h)) return false;
    if (max_speed(state_.v) < speed) return true;
  }
  return false;
}

Vec3 Rig::pull_on(const std::vector<int>& vertices) const {
  const VecX force = system_.force(state_.x, VecX::Zero(state_.x.size()));
  Vec3 sum = Vec3::Zero();
  for (int i : vertices) sum += force.segment<3>(3 * i);
  return sum;
}

}  // namespace drape::app
