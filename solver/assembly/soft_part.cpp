// A soft body becomes a part of an assembly: a lattice of particles, or the vertices of tetrahedra.
#include <cmath>
#include <numeric>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/lattice/solid.h"
#include "mesh/triangles/mesh_frames.h"
#include "solver/assembly/assembly.h"
#include "solver/assembly/soft_forces.h"
#include "solver/forces/cluster_force.h"
#include "solver/forces/cluster_sets.h"
#include "solver/forces/tetrahedra_springs.h"

namespace drape {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

void place(const Pose& pose, const std::string& name, std::vector<Vec3>& positions) {
  for (Vec3& x : positions) {
    x = pose.to_world(x);
    if (!x.allFinite()) throw InputError(name + ": its place puts a vertex out of the range of numbers");
  }
}

Pairs pairs_of(const Cloth& soft) {
  if (soft.tetrahedra) return edges_of(*soft.tetrahedra);
  Pairs all;
  for (const auto* pairs : {&soft.lattice->structural, &soft.lattice->shear, &soft.lattice->bend})
    for (const LatticePair& p : *pairs) all.emplace_back(p.i, p.j);
  return all;
}

const std::vector<Vec3>& rest_of(const Cloth& soft) {
  return soft.tetrahedra ? soft.tetrahedra->positions : soft.lattice->positions;
}

double volume_of_cells(const Cloth& soft) {
  const std::vector<double> volumes =
      soft.tetrahedra ? vertex_volumes(*soft.tetrahedra) : soft.lattice->volumes;
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

// m^3, of the mesh that a lattice carries, or else of what the body is made of.
double volume_of(const Cloth& soft) {
  return soft.lattice ? solid_of(soft.mesh).volume : volume_of_cells(soft);
}

// m, the length of a cell, or of an edge of a tetrahedron, about.
double size_of_cell(const Cloth& soft) {
  return soft.tetrahedra
             ? std::cbrt(volume_of_cells(soft) / static_cast<double>(soft.tetrahedra->positions.size()))
             : soft.lattice->spacing[0];
}

std::vector<double> masses_of(const Cloth& soft) {
  return soft.tetrahedra ? masses(*soft.tetrahedra, soft.material)
                         : masses(*soft.lattice, soft.material, volume_of(soft));
}

ParticleSets cluster_sets(const Cloth& soft) {
  constexpr int rings = 1;  // of neighbours, by which clusters overlap
  if (soft.clusters->count > 0)
    return overlapping_sets(rest_of(soft), pairs_of(soft), soft.clusters->count, rings, soft.name);
  return soft.tetrahedra ? sets_of(soft.tetrahedra->tetrahedra) : sets_of_cells(*soft.lattice);
}

std::unique_ptr<Force> clusters_of(const Cloth& soft) {
  if (!soft.material.young)
    throw InputError(soft.name + ": clusters take young; structural, shear and bend are springs");
  ParticleSets sets = cluster_sets(soft);
  const auto first = static_cast<std::size_t>(soft.first_particle);
  const std::vector<double> own = masses_of(soft);
  std::vector<double> all(first, 1.0);
  all.insert(all.end(), own.begin(), own.end());
  for (auto& set : sets)
    for (int& particle : set) particle += soft.first_particle;
  std::vector<Vec3> rest(first, Vec3::Zero());
  rest.insert(rest.end(), rest_of(soft).begin(), rest_of(soft).end());
  Clusters clusters(sets, all, stacked(rest), soft.name);
  const double mass = std::accumulate(own.begin(), own.end(), 0.0);
  const double k = cluster_stiffness(clusters, *soft.material.young, mass / volume_of(soft));
  return std::make_unique<ClusterForce>(std::move(clusters), k, soft.material.viscosity);
}

}  // namespace

std::vector<std::unique_ptr<Force>> internal::soft_forces(const Cloth& soft) {
  if (!soft.clusters && soft.material.viscosity > 0)
    throw InputError(soft.name + ": viscosity is of clusters; springs take damping");
  if (!soft.clusters)
    return soft.tetrahedra ? soft_body(*soft.tetrahedra, soft.material, soft.first_particle)
                           : soft_body(*soft.lattice, soft.material, soft.first_particle);
  std::vector<std::unique_ptr<Force>> forces;
  forces.push_back(clusters_of(soft));
  return forces;
}

Cloth& Assembly::add(SoftPart part) {
  if (system) throw InputError(part.name + ": is added after use(); add all soft bodies before it");
  Cloth cloth;
  cloth.name = std::move(part.name);
  if (part.tetrahedra)
    cloth.tetrahedra = std::make_shared<const TetrahedralMesh>(std::move(*part.tetrahedra));
  else
    cloth.lattice = std::make_shared<const Lattice>(std::move(part.lattice));
  cloth.material = part.material;
  cloth.clusters = part.clusters;
  const int first = state.particles();
  std::vector<Vec3> positions = rest_of(cloth);
  cloth.first_particle = first;
  cloth.end_particle = first + static_cast<int>(positions.size());
  std::vector<int> on_surface;
  const TriangleMesh surface =
      cloth.tetrahedra ? surface_of(*cloth.tetrahedra, on_surface) : surface_of(*cloth.lattice, on_surface);
  if (part.mesh && cloth.lattice) {
    cloth.mesh = std::move(*part.mesh);
    cloth.embedding = embedding_in(*cloth.lattice, cloth.mesh.positions, first);
  } else {
    cloth.mesh = surface;
    for (int p : on_surface) cloth.embedding.add_vertex(first + p);
  }
  const std::vector<double> masses = masses_of(cloth);
  place(part.place, cloth.name, cloth.mesh.positions);
  cloth.report = examine(cloth.mesh);
  const Pairs pairs = pairs_of(cloth);
  for (const auto& [i, j] : pairs)
    cloth.edges.push_back(
        {first + i, first + j,
         (positions[static_cast<std::size_t>(i)] - positions[static_cast<std::size_t>(j)]).norm()});
  place(part.place, cloth.name, positions);
  const auto count = [](const auto& all) { return static_cast<int>(all.size()); };
  cloth.soft = cloth.tetrahedra ? LatticeCounts{count(pairs), 0, 0}
                                : LatticeCounts{count(cloth.lattice->structural), count(cloth.lattice->shear),
                                                count(cloth.lattice->bend)};
  connect(cloth, forces_);
  const double stiffness =
      cloth.material.young ? *cloth.material.young * size_of_cell(cloth) : cloth.material.structural;
  std::vector<Triangle> faces = surface.triangles;
  for (Triangle& t : faces) {
    for (int& v : t) v = first + on_surface[static_cast<std::size_t>(v)];
    faces_.push_back({t, stiffness});
  }
  if (part.self_contact)
    meet(cloth, *part.self_contact, faces,
         std::vector<std::optional<int>>(faces.size(), part.self_contact->layer));
  return take(std::move(cloth), positions, masses);
}

}  // namespace drape
