#include "solver/forces/tetrahedra_springs.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "mesh/base/errors.h"

namespace drape {

std::vector<double> masses(const TetrahedralMesh& mesh, const SoftMaterial& material) {
  check(material);
  std::vector<double> all = vertex_volumes(mesh);
  const double volume = std::accumulate(all.begin(), all.end(), 0.0);
  const double mass = material.mass.value_or(material.density * volume);
  for (double& one : all)
    one = material.equal_masses ? mass / static_cast<double>(all.size()) : mass * one / volume;
  return all;
}

std::vector<std::unique_ptr<Force>> soft_body(const TetrahedralMesh& mesh, const SoftMaterial& material,
                                              int first_particle) {
  check(material);
  if (!material.young)
    throw InputError("a body of tetrahedra takes young; structural, shear and bend are springs of a lattice");
  std::map<std::pair<int, int>, double> volumes;  // m^3, round each edge
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) volumes[std::minmax(t[a], t[b])] += volume_of(mesh, t);
  std::vector<SoftSpring> springs;
  for (const auto& [edge, volume] : volumes) {
    const auto [i, j] = edge;
    const double l =
        (mesh.positions[static_cast<std::size_t>(i)] - mesh.positions[static_cast<std::size_t>(j)]).norm();
    springs.push_back({first_particle + i, first_particle + j, l, *material.young * volume / (l * l)});
  }
  return forces_of(springs, material);
}

}  // namespace drape
