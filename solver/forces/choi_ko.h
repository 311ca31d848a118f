// The connections of a regular grid of quads.                                     [Choi & Ko 2002, section 3]
//   type 1  stretch, to the 4 neighbours and the 4 diagonal neighbours
//   type 2  bend, to the next but one along rows, columns and diagonals
// Of a fabric of membrane stiffness Y [N/m] and bending rigidity B [N m] (cylindrical, per width), on cells
// of a x b [m], d^2 = a^2 + b^2: an isotropic sheet and an isotropic plate, both with Poisson's ratio 1/3.
//   sides of length a  k_s = Y (9/8 b/a - 3/8 a/b), of which each cell beside it gives half
//   diagonals          k_s = 3/16 Y d^2 / (a b)
//   rows along a       k_b = B_a w L^3 / (6 h_1 h_2 (h_1 + h_2)),  B_a = B (1 - a^2 / (3 b^2)),  w = b
//   along diagonals    the same with  B_d = B d^4 / (6 a^2 b^2),  w = a b / d
//     h_1, h_2 [m]: the two links of the connection, L its rest length; on squares k_s = 3/4 Y and 3/8 Y,
//     k_b = 4/9 B a and 4/9 B a sqrt(2).  From C_ijkl = sum_e k_e l_e^2 t_i t_j t_k t_l / A, and the same of
//     bending.
//   or k_s and k_b given, the same for every connection, as in the paper.
//   A cell longer than sqrt(3) times its width would need springs that push: those get none, and the sheet is
//   then stiffer across than along (longest_cell tells).
// The clamp makes a connection limp below  kappa = sqrt(96 k_b / (c_b L h_1 h_2 (h_1 + h_2)^2)).
//
// Rest shape: as in solver/forces/noh_jung.h, but it may not be cut.
#pragma once

#include "mesh/obj/quad_grid.h"
#include "solver/forces/connections.h"

namespace drape {

// Throws InputError when the mesh is no regular grid, the rest shape is cut, or the fabric is none.
Connections choi_ko_connections(const TriangleMesh& mesh, const TriangleMesh& rest, const Fabric& fabric);

// kg: a quarter of every quad's mass to each of its vertices; as lumped_mass otherwise.
std::vector<double> choi_ko_mass(const TriangleMesh& mesh, const TriangleMesh& rest, double area_density);

// Stretch, bend and damping of a cloth that rests as the mesh is, vertex 0 being the particle
// `first_particle` of the system.
std::vector<std::unique_ptr<Force>> choi_ko(const TriangleMesh& mesh, const Fabric& fabric,
                                            int first_particle = 0);

// The largest ratio of length and width of a cell at rest.
double longest_cell(const TriangleMesh& mesh, const TriangleMesh& rest);

}  // namespace drape
