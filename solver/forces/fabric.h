// What a cloth is made of, in numbers a textile laboratory gives, and the masses made from them. The models
// (solver/forces/noh_jung.h, solver/forces/choi_ko.h) make connections from the same numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/force.h"

namespace drape {

struct Fabric {
  double area_density = 0.15;                 // kg/m^2
  double stretch = 500;                       // N/m, membrane stiffness per width Y
  double bend = 1e-5;                         // N m, bending rigidity per width B
  std::optional<double> stretch_spring = {};  // N/m, k_s of every edge; replaces stretch
  std::optional<double> bend_spring = {};     // N m^2, k_b of every diagonal; replaces bend
  std::optional<double> buckling_clamp = {};  // N/m, c_b of every diagonal
  double damping = 0;                         // N s/m, k_d of every connection
  DampingKind damping_kind = DampingKind::relative;
  bool neighbour_weighting = false;  // Noh & Jung eq. 1-3
};

// Throws InputError naming the field when a value is negative, not finite, or zero where it may not be.
void check(const Fabric& fabric);

// kg, of the area around every vertex [m^2]. A vertex of faces without area gets a thousandth of the mean, so
// that it can move; a vertex without faces gets 0 and stays.
std::vector<double> mass_of_areas(std::vector<double> areas, const TriangleMesh& mesh, double area_density);

// kg: a third of every triangle's mass to each of its vertices.
std::vector<double> lumped_mass(const TriangleMesh& mesh, double area_density);
// The same of a cloth that rests otherwise: triangle k of the mesh has the area of the rest's triangle k.
std::vector<double> lumped_mass(const TriangleMesh& mesh, const TriangleMesh& rest, double area_density);

}  // namespace drape
