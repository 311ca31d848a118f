// The connections of a regular grid of quads.                                     [Choi & Ko 2002, section 3]
//   type 1  stretch, to the 4 neighbours and the 4 diagonal neighbours
//   type 2  bend, to the next but one along rows, columns and diagonals
// The fabric has the membrane stiffness Y [N/m] and the bending rigidity B [N m] (cylindrical, per width); a
// cell measures a x b [m], d^2 = a^2 + b^2. The connections make an isotropic sheet and an isotropic plate,
// both with Poisson's ratio 1/3:
//   sides of length a  k_s = Y (9/8 b/a - 3/8 a/b), of which each cell beside the side gives half
//   diagonals          k_s = 3/16 Y d^2 / (a b)
//   rows along a       k_b = B_a w L^3 / (6 h_1 h_2 (h_1 + h_2)),  B_a = B (1 - a^2 / (3 b^2)),  w = b
//   along diagonals    the same with  B_d = B d^4 / (6 a^2 b^2),  w = a b / d
//     h_1, h_2 [m]: the two links of the connection, L [m]: its rest length. On squares k_s = 3/4 Y and
//     3/8 Y, k_b = 4/9 B a and 4/9 B a sqrt(2). The numbers follow from
//     C_ijkl = sum_e k_e l_e^2 t_i t_j t_k t_l / A and the same equation for bending.
//   Or k_s and k_b are given and the same for every connection, as in the paper.
//   A cell longer than sqrt(3) times its width would need springs that push. Those springs get no stiffness,
//   and the sheet is then stiffer across than along (longest_cell tells).
// The clamp makes a connection limp below  kappa = sqrt(96 k_b / (c_b L h_1 h_2 (h_1 + h_2)^2)).
//
// The rest shape is given as in solver/forces/noh_jung.h, but it may not be cut.
#pragma once

#include "mesh/obj/quad_grid.h"
#include "solver/forces/connections.h"

namespace drape {

// Throws InputError when the mesh is not a regular grid, the rest shape is cut, or a value of the fabric is
// wrong.
Connections choi_ko_connections(const TriangleMesh& mesh, const TriangleMesh& rest, const Fabric& fabric);

// The masses of the vertices [kg]: every quad gives a quarter of its mass to each of its vertices. Otherwise
// the same as lumped_mass.
std::vector<double> choi_ko_mass(const TriangleMesh& mesh, const TriangleMesh& rest, double area_density);

// The stretch, bend and damping forces of a cloth that rests in the shape of the mesh. Vertex 0 is the
// particle `first_particle` of the system.
std::vector<std::unique_ptr<Force>> choi_ko(const TriangleMesh& mesh, const Fabric& fabric,
                                            int first_particle = 0);

// The largest ratio of length to width of a cell at rest.
double longest_cell(const TriangleMesh& mesh, const TriangleMesh& rest);

}  // namespace drape
