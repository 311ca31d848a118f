// The material of a cloth in numbers that a textile laboratory gives, and the masses made from them. The
// models (solver/forces/noh_jung.h, solver/forces/choi_ko.h) make connections from the same numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/force.h"

namespace drape {

// How a woven cloth resists bending.
enum class Bending {
  plate,             // solver/forces/plate.h: right in every direction on any mesh
  hinges,            // the angles between triangles, solver/forces/hinge.h
  quadratic_hinges,  // their quadratic form, which rests flat
};

// What the woven model (solver/forces/woven.h) knows besides. Unset: as of a fabric that is the same in all
// directions. The stiffnesses of Fabric are then those along the warp. Models of springs take the means of
// warp and weft, and nothing else of this.
struct Weave {
  std::optional<double> stretch_weft = {}, shear = {};  // N/m, Y along the weft, and G
  double poisson = 0.3;                                 // geometric mean of the two Poisson's ratios
  double compression = 1;  // share of the resistance to compression that stays, from 0 to 1
  std::optional<double> bend_weft = {}, bend_bias = {};  // N m, B along the weft and at 45 degrees
  double bend_poisson = 0;
  Bending bending = Bending::plate;
  // N, the moment of dry friction per width against bending along warp and weft
  // (solver/forces/plate_friction.h): half of the width 2HB of the loop of KES-FB2. 0: there is none.
  double bend_friction = 0;
  std::optional<double> bend_friction_weft = {};
  // 1/m, the change of curvature within which that moment sets in. KES-FB2 reads B from 50 1/m on, where it
  // has.
  double bend_friction_onset = 50;
  double stretch_time = 0, shear_time = 0, bend_time = 0;  // s, viscosity over stiffness
  // The share of the curvature of the mesh, as the cloth starts, with which it rests: 0 is flat, 1 the mesh.
  double rest_angle = 0;
};

struct Fabric {
  double area_density = 0.15;                 // kg/m^2
  double stretch = 500;                       // N/m, membrane stiffness Y per width
  double bend = 1e-5;                         // N m, bending rigidity B per width
  std::optional<double> stretch_spring = {};  // N/m, k_s of every edge; replaces stretch
  std::optional<double> bend_spring = {};     // N m^2, k_b of every diagonal; replaces bend
  std::optional<double> buckling_clamp = {};  // N/m, c_b of every diagonal
  double damping = 0;                         // N s/m, k_d of every connection
  DampingKind damping_kind = DampingKind::relative;
  bool neighbour_weighting = false;  // Noh & Jung eq. 1-3
  Weave weave = {};
};

// The arithmetic means of warp and weft: what a model takes that is the same in all directions.
double mean_stretch(const Fabric& fabric);  // N/m
double mean_bend(const Fabric& fabric);     // N m

// Throws InputError, which names the field, when a value is negative, not finite, or zero where it may not
// be.
void check(const Fabric& fabric);

// The masses [kg] of vertices with these areas [m^2]. A vertex whose faces have no area gets a thousandth of
// the mean mass, so that it can move; a vertex without faces gets 0 and does not move. Throws InputError
// unless area_density [kg/m^2] is greater than zero.
std::vector<double> mass_of_areas(std::vector<double> areas, const TriangleMesh& mesh, double area_density);

// The masses of the vertices [kg]: every triangle gives a third of its mass to each of its vertices.
std::vector<double> lumped_mass(const TriangleMesh& mesh, double area_density);
// The same for a cloth with another rest shape: triangle k of the mesh has the area of triangle k of `rest`.
std::vector<double> lumped_mass(const TriangleMesh& mesh, const TriangleMesh& rest, double area_density);

}  // namespace drape
