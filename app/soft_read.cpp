#include "app/soft_read.h"

#include <algorithm>

#include "app/obstacle_read.h"
#include "mesh/obj.h"

namespace drape {
namespace {

void read_counts(Table& table, SoftEntry& soft) {
  std::vector<int> counts;
  table.read_required("particles", counts);
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
  table.read("spacing", spacing, dimension::length, Range::positive);
  soft.spacing.setConstant(spacing);
  if (!table.has("size")) return;
  table.read("size", soft.spacing, dimension::length);
  if (!(soft.spacing.minCoeff() > 0)) table.fail("size", "expected three lengths greater than zero");
  for (std::size_t a = 0; a < 3; ++a) soft.spacing[static_cast<Eigen::Index>(a)] /= soft.particles[a] - 1;
}

// Springs by a modulus, or the constants of all three kinds.
void read_springs(Table& table, SoftMaterial& material) {
  const bool springs = table.has("structural") || table.has("shear") || table.has("bend");
  if (springs && table.has("young")) table.fail("young", "give either young, or structural, shear and bend");
  table.read("young", material.young, dimension::pressure, Range::positive);
  if (!springs) return;
  material.young.reset();
  table.read_required("structural", material.structural, dimension::spring, Range::not_negative);
  table.read_required("shear", material.shear, dimension::spring, Range::not_negative);
  table.read_required("bend", material.bend, dimension::spring, Range::not_negative);
}

void read_material(Table& table, SoftMaterial& material) {
  if (table.has("density") && table.has("mass")) table.fail("mass", "give either density or mass, not both");
  table.read("density", material.density, dimension::density, Range::positive);
  table.read("mass", material.mass, dimension::mass, Range::positive);
  table.read("equal_masses", material.equal_masses);
  read_springs(table, material);
  table.read("damping", material.damping, dimension::damping, Range::not_negative);
  std::string kind = "axial";
  table.read("damping_kind", kind, {"relative", "axial"});
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
    soft.mesh = read_path(table, "mesh", folder);
    double spacing = 0;
    table.read_required("spacing", spacing, dimension::length, Range::positive);
    soft.spacing.setConstant(spacing);
  } else {
    read_box(table, soft);
  }
  soft.placement = read_placement(table);
  read_material(table, soft.material);
  return soft;
}

}  // namespace drape
