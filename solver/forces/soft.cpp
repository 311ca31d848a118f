#include "solver/forces/soft.h"

#include <cmath>
#include <numeric>

#include "mesh/base/errors.h"
#include "solver/forces/damping.h"
#include "solver/forces/linear_spring.h"
#include "solver/forces/require.h"

namespace drape {
namespace {

void add_springs(const Lattice& lattice, const std::vector<LatticePair>& pairs, double k, bool by_cells,
                 int first, std::vector<SoftSpring>& springs) {
  if (k == 0) return;
  for (const LatticePair& pair : pairs) {
    const double L = (lattice.positions[pair.i] - lattice.positions[pair.j]).norm();
    springs.push_back({first + pair.i, first + pair.j, L, by_cells ? k * pair.cells : k});
  }
}

}  // namespace

void check(const SoftMaterial& m) {
  require(m.density > 0, "density", m.density, "kg/m^3", "a density is greater than zero");
  if (m.mass) require(*m.mass > 0, "mass", *m.mass, "kg", "a mass is greater than zero");
  if (m.young) require(*m.young > 0, "young", *m.young, "Pa", "a modulus is greater than zero");
  require(m.structural >= 0, "structural", m.structural, "N/m", "a stiffness is not negative");
  require(m.shear >= 0, "shear", m.shear, "N/m", "a stiffness is not negative");
  require(m.bend >= 0, "bend", m.bend, "N/m", "a stiffness is not negative");
  require(m.viscosity >= 0, "viscosity", m.viscosity, "s", "a time is not negative");
  require(m.damping >= 0, "damping", m.damping, "N.s/m", "a damping coefficient is not negative");
}

std::vector<double> masses(const Lattice& lattice, const SoftMaterial& material,
                           std::optional<double> volume) {
  check(material);
  const double cells = std::accumulate(lattice.volumes.begin(), lattice.volumes.end(), 0.0);
  const double all = material.mass.value_or(material.density * volume.value_or(cells));
  std::vector<double> masses(lattice.volumes.size(), all / static_cast<double>(lattice.volumes.size()));
  if (!material.equal_masses)
    for (std::size_t i = 0; i < masses.size(); ++i) masses[i] = all / cells * lattice.volumes[i];
  return masses;
}

std::vector<std::unique_ptr<Force>> soft_body(const Lattice& lattice, const SoftMaterial& material,
                                              int first_particle) {
  check(material);
  double structural = material.structural, shear = material.shear, bend = material.bend;
  if (material.young) {
    const Vec3& a = lattice.spacing;
    require(
        a.maxCoeff() - a.minCoeff() <= 1e-9 * a.maxCoeff(), "young", *material.young, "Pa",
        "a modulus needs cubic cells, of the same spacing along x, y and z; or give structural, shear and "
        "bend instead");
    structural = 22.0 / 35 * *material.young * a[0];
    shear = 6.0 / 35 * *material.young * a[0];
    bend = 0;
  }
  std::vector<SoftSpring> springs;
  const bool by_cells = material.young.has_value();
  add_springs(lattice, lattice.structural, structural, by_cells, first_particle, springs);
  add_springs(lattice, lattice.shear, shear, by_cells, first_particle, springs);
  add_springs(lattice, lattice.bend, bend, by_cells, first_particle, springs);
  return forces_of(springs, material);
}

std::vector<std::unique_ptr<Force>> forces_of(const std::vector<SoftSpring>& springs,
                                              const SoftMaterial& material) {
  std::vector<std::unique_ptr<Force>> forces;
  if (springs.empty()) return forces;
  const bool axial = material.damping_kind == DampingKind::axial;
  if (material.damping > 0 && !axial) {
    std::vector<PairDamping::Element> damped;
    damped.reserve(springs.size());
    for (const SoftSpring& s : springs) damped.push_back({{s.i, s.j}});
    forces.push_back(
        std::make_unique<PairDamping>(std::move(damped), material.damping, material.damping_kind));
  }
  std::vector<PairForce<LinearSpring>::Element> elements;
  elements.reserve(springs.size());
  for (const SoftSpring& s : springs) elements.push_back({{s.i, s.j}, {s.L, s.k}});
  forces.push_back(
      std::make_unique<PairForce<LinearSpring>>(std::move(elements), axial ? material.damping : 0));
  return forces;
}

}  // namespace drape
