#include "app/simulation/cloth_model.h"

#include <cmath>

#include "mesh/base/errors.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/noh_jung.h"

namespace drape {
namespace {

void warn_if_limp(const ClothEntry& cloth, const Connections& connections, Names& messages) {
  const double curvature = limp_below(connections, cloth.fabric);
  if (!(curvature > 2 * limp_curvature(cloth.fabric.bend, cloth.fabric.area_density))) return;
  messages.push_back("warning: cloth " + cloth.name +
                     ": the buckling clamp makes it limp below a curvature of " + rounded(curvature, 2) +
                     " 1/m (a radius of " + rounded(100 / curvature, 2) +
                     " cm): gentler folds have no bending stiffness; raise buckling_clamp, or leave it out");
}

void warn_if_long(const ClothEntry& cloth, const TriangleMesh& mesh, const TriangleMesh& rest,
                  Names& messages) {
  const bool of_fabric = !cloth.fabric.stretch_spring || !cloth.fabric.bend_spring;
  const double longest = longest_cell(mesh, rest);
  if (!of_fabric || longest <= std::sqrt(3.0)) return;
  messages.push_back("warning: cloth " + cloth.name + ": has cells " + rounded(longest, 3) +
                     " times as long as wide; beyond 1.73 the grid's springs make it stiffer across than "
                     "along; use a grid of squares, or model = \"noh-jung\"");
}

// make() is asked of a mesh that may be no grid.
template <class Make>
auto of_grid(const ClothEntry& entry, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(entry.where + ": model = \"choi-ko\": " + entry.mesh.string() + ": " + error.what() +
                     "; use model = \"noh-jung\" for any other mesh");
  }
}

Connections connections_of(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest) {
  if (entry.model != "choi-ko") return noh_jung_connections(mesh, rest, entry.fabric);
  return of_grid(entry, [&] { return choi_ko_connections(mesh, rest, entry.fabric); });
}

}  // namespace

std::vector<double> cloth_masses(const ClothEntry& entry, const TriangleMesh& mesh,
                                 const TriangleMesh& rest) {
  const double density = entry.fabric.area_density;
  std::vector<double> masses = entry.model == "choi-ko"
                                   ? of_grid(entry, [&] { return choi_ko_mass(mesh, rest, density); })
                                   : lumped_mass(mesh, rest, density);
  if (!entry.fabric.neighbour_weighting) return masses;
  return neighbour_weighted(std::move(masses), connections_of(entry, mesh, rest));
}

Connections cloth_connections(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                              Names& messages) {
  Connections connections = connections_of(entry, mesh, rest);
  if (entry.model == "choi-ko") warn_if_long(entry, mesh, rest, messages);
  warn_if_limp(entry, connections, messages);
  return connections;
}

}  // namespace drape
