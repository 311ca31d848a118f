// Bending by the angles between triangles: every edge between two triangles is a hinge.
//   E = 1/2 k d^2,   k = B_n l^2 / (A_c + A_d),   d = theta - theta_0      [after Grinspun et al. 2003]
// l [m] is the length of the edge at rest, A_c and A_d [m^2] the areas of the triangles, and B_n [N m] the
// rigidity against bending across the edge: D_11 n_u^4 + D_22 n_v^4 + (2 D_12 + 4 D_66) n_u^2 n_v^2. The
// difference d of the angles is taken from -pi to pi: a triangle that is folded past its neighbour is pushed
// on, the shorter way round. A fold that is pressed flat has an angle of pi or -pi, by round-off: with a rest
// angle that is a share of it, it opens to either side.
//
// With this weight equilateral triangles resist with B; the weights of the papers named here are six and
// three times as large. What a mesh of hinges resists depends on where its edges run: equilateral triangles
// are a plate whose Poisson's ratio is -1/3, whatever was asked; squares with parallel diagonals have B along
// the sides and 3 B along the diagonals, squares with alternating diagonals 0.83 B along the sides and 1.33 B
// at 45 degrees. The plate of solver/forces/plate.h is right in every direction; hinges are what most other
// programs have.
//
// Hinges that rest flat have a quadratic form [Bergou et al. 2006], whose stiffness is constant:
//   E = 1/2 k |s|^2,   s = the sum of the slopes of the two triangles from the edge inward,   |s| = 2 sin(theta / 2)
#pragma once

#include <memory>

#include "solver/forces/force.h"
#include "solver/forces/plate.h"

namespace drape::internal {

// corners, rest_angle: as of plate_energy; and so are the edges that bend freely. Vertex 0 is the particle
// `first_particle`. time [s]: viscosity over stiffness.
std::unique_ptr<Force> hinge_force(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                                   const PlateStiffness& stiffness, double rest_angle, double time,
                                   int first_particle = 0);

// The quadratic form, which rests flat.
PlateEnergy quadratic_hinges(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                             const PlateStiffness& stiffness);

}  // namespace drape::internal
