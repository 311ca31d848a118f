#include "app/scene/soft_read.h"

#include <algorithm>

#include "app/scene/obstacle_read.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

void read_counts(Table& table, SoftEntry& soft) {
  std::vector<int> counts;
  table.read_required("particles", counts,
                      "along x, y and z: [10, 10, 10]; the box is centred on the origin before it is placed");
  if (counts.size() != 3 || *std::min_element(counts.begin(), counts.end()) < 2)
    table.fail("particles",
               "expected how many there are along x, y and z, at least 2 each, such as [10, 10, 10]");
  std::copy(counts.begin(), counts.end(), soft.particles.begin());
}

// Of a box: one length, or the edges of all of it.
void read_box(Table& table, SoftEntry& soft) {
  read_counts(table, soft);
  if (table.has("size") == table.has("spacing"))
    table.fail(table.has("size") ? "size" : "", "give either spacing or size, of a box of particles");
  double spacing = 0;
  table.read("spacing", spacing, dimension::length, Range::positive,
             {"between neighbours; this or size", "by size"});
  soft.spacing.setConstant(spacing);
  Vec3 size = Vec3::Zero();
  table.read("size", size, dimension::length, {"the three edges of the box; this or spacing", "by spacing"});
  if (!table.has("size")) return;
  soft.spacing = size;
  if (!(soft.spacing.minCoeff() > 0)) table.fail("size", "expected three lengths greater than zero");
  for (std::size_t a = 0; a < 3; ++a) soft.spacing[static_cast<Eigen::Index>(a)] /= soft.particles[a] - 1;
}

void read_cubes(Table& table, SoftEntry& soft) {
  const bool tetrahedra = is_tetrahedra(soft.mesh);
  if (tetrahedra && table.has("spacing"))
    table.fail("spacing", "tetrahedra are taken as they are; leave spacing out");
  double spacing = 0;
  if (!tetrahedra) table.require("spacing");
  table.read("spacing", spacing, dimension::length, Range::positive,
             {"the edge of the cubes, which scale leaves as it is; not of tetrahedra", "none"});
  soft.spacing.setConstant(spacing);
}

// One cluster for each cell or tetrahedron, or so many.
void read_clusters(Table& table, SoftEntry& soft) {
  const Node* const node = table.take("clusters", "\"tetrahedra\", \"cells\", or a number",
                                      {"what holds the body together instead of springs, for `pbd` and "
                                       "explicit integrators: one for each tetrahedron or cell, "
                                       "or so many that overlap; stiff by `young`",
                                       "springs"});
  if (!node) return;
  const std::string one = is_tetrahedra(soft.mesh) ? "tetrahedra" : "cells";
  if (node->kind == Node::Kind::text && node->text == one)
    soft.clusters = SoftClusters{};
  else if (node->kind == Node::Kind::integer && node->integer >= 1 && node->integer < 1000000)
    soft.clusters = SoftClusters{static_cast<int>(node->integer)};
  else
    table.fail("clusters", "expected \"" + one + "\", or how many, such as 12");
}

// Springs by a modulus, or the constants of all three kinds.
void read_springs(Table& table, SoftMaterial& material) {
  const bool springs = table.has("structural") || table.has("shear") || table.has("bend");
  if (springs && table.has("young")) table.fail("young", "give either young, or structural, shear and bend");
  table.read("young", material.young, dimension::pressure, Range::positive,
             "of an isotropic solid with Poisson's number 1/4; of a lattice, with cubic cells only");
  const char* const instead = "by young";
  table.read("structural", material.structural, dimension::spring, Range::not_negative,
             {"every spring along an edge of a cell; this, shear and bend, instead of young", instead});
  table.read("shear", material.shear, dimension::spring, Range::not_negative,
             {"every spring along a diagonal of a face or a cell", instead});
  table.read("bend", material.bend, dimension::spring, Range::not_negative,
             {"every spring to the next particle but one", instead});
  for (const char* key : {"structural", "shear", "bend"})
    if (springs) table.require(key);
  if (springs) material.young.reset();
}

void read_material(Table& table, SoftMaterial& material) {
  if (table.has("density") && table.has("mass")) table.fail("mass", "give either density or mass, not both");
  table.read("density", material.density, dimension::density, Range::positive,
             "of the mesh's own volume, or of the box; shared by the cells round a particle");
  table.read("mass", material.mass, dimension::mass, Range::positive, {"instead of density", "by density"});
  table.read("equal_masses", material.equal_masses, "the mass in equal parts to all particles");
  read_springs(table, material);
  table.read("damping", material.damping, dimension::damping, Range::not_negative, "of every spring");
  std::string kind = "axial";
  table.read("damping_kind", kind, Names{"relative", "axial"},
             "axial: of what goes along the spring; relative: of every difference of velocity");
  table.read(
      "viscosity", material.viscosity, dimension::time, Range::not_negative,
      {"of clusters: viscosity over stiffness; a mode of the angular frequency w dies away with the rate "
       "w^2 viscosity / 2, and what moves rigidly is not slowed",
       "0"});
  material.damping_kind = kind == "axial" ? DampingKind::axial : DampingKind::relative;
}

}  // namespace

SoftEntry read_soft(Table& table, const std::filesystem::path& folder) {
  SoftEntry soft;
  soft.where = table.where();
  if (table.has("mesh") == table.has("particles"))
    table.fail(table.has("mesh") ? "particles" : "",
               "expected either particles = [10, 10, 10] of a box, or mesh = \"body.obj\" to be filled");
  if (table.has("mesh")) {
    table.only_of("of a mesh that is filled");
    soft.mesh = read_path(table, folder, "a closed OBJ file, filled with cubes; or tetrahedra of Gmsh, .msh");
    read_cubes(table, soft);
  } else {
    table.only_of("of a box of particles");
    read_box(table, soft);
  }
  table.only_of({});
  soft.placement = read_placement(table);
  read_clusters(table, soft);
  read_material(table, soft.material);
  if (!soft.material.young && (soft.clusters || is_tetrahedra(soft.mesh)))
    table.fail("structural", "is of the springs of a lattice; expected young");
  if (soft.clusters && table.has("damping"))
    table.fail("damping", "is of springs, and clusters have none; they take viscosity");
  if (!soft.clusters && table.has("viscosity"))
    table.fail("viscosity", "is of clusters; springs take damping");
  return soft;
}

}  // namespace drape::app
