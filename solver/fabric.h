// What a cloth is made of, in numbers a textile laboratory gives, and the connections of Noh & Jung's model
// made from them.
//
//   every edge      TensionSpring   k_s = Y (A_1 + A_2) / l^2                      [Van Gelder 1998, eq. 4]
//   every diagonal  BucklingSpring  k_b = B l L^3 / (6 h_1 h_2 (h_1 + h_2))        [Choi & Ko 2002; beam of
//   order 2]
//     Y [N/m]: membrane stiffness per width; B [N m]: bending rigidity per width; l: the edge; A, h: area and
//     height over it of the triangles beside it; L: rest length of the connection. So the same fabric on a
//     finer mesh is the same fabric.
//   or k_s [N/m] and k_b [N m^2] given, the same for every connection, as in the papers of Noh & Jung and of
//   Choi & Ko.
//
// The clamp c_b [N/m] of the diagonals makes their response continuous but removes bending rigidity below
//   kappa = sqrt(96 k_b / (c_b L h_1 h_2 (h_1 + h_2)^2))
// By default c_b is chosen so that this is at most a tenth of the curvature that the fabric takes under its
// own weight,
//   limp_curvature = 0.1 / c,  c = (B / (sigma g))^(1/3) its bending length,
// but between k_s and stiffest_clamp k_s: a clamp stiffer than that would cost more than the rigidity is
// worth (limp_below says when a mesh is so fine that it shows).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/force.h"

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

// 0.1 / c [1/m], of a bending rigidity B [N m] and an area density [kg/m^2] under g = 9.81 m/s^2.
double limp_curvature(double bend, double area_density);

inline constexpr double stiffest_clamp = 10;  // times k_s

// Throws InputError naming the field when a value is negative, not finite, or zero where it may not be.
void check(const Fabric& fabric);

// kg: a third of every triangle's mass to each of its vertices. A vertex of triangles without area gets a
// thousandth of the mean, so that it can move; a vertex without triangles gets 0 and stays.
std::vector<double> lumped_mass(const TriangleMesh& mesh, double area_density);

// m_i / w_i with w_i = max_k N_k / N_i, N_i the number of vertices connected to i by an edge or a diagonal:
// exactly Noh & Jung's weighted forces, as a symmetric system.
std::vector<double> neighbour_weighted(std::vector<double> masses, const TriangleMesh& mesh);

// Masses of the fabric: lumped, weighted if the fabric says so.
std::vector<double> masses(const TriangleMesh& mesh, const Fabric& fabric);

// Stretch, bend and damping of a cloth whose vertex 0 is particle `first_particle` of the system.
std::vector<std::unique_ptr<Force>> noh_jung(const TriangleMesh& mesh, const Fabric& fabric,
                                             int first_particle = 0);

// The curvature [1/m] below which the clamp makes this cloth limp: the median over its diagonals. 0 without
// diagonals.
double limp_below(const TriangleMesh& mesh, const Fabric& fabric);

}  // namespace drape
