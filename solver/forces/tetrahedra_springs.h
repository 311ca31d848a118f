// A body of tetrahedra as springs along its edges, which resist both ways.
//   k = Y sum V / l^2,   over the tetrahedra round the edge
// Y [Pa]: Young's modulus, V [m^3], l [m]: length of the edge. With C_ijkl = 1/V sum k l^2 t_i t_j t_k t_l,
// and edges in all directions alike, it is the modulus of an isotropic solid of Poisson's ratio 1/4, the only
// one that springs between points can have: sum k l^2 = 6 Y V, C_11 = 6/5 Y, Y = 5/6 C_11. A mesh whose edges
// prefer a direction is stiffer there.
#pragma once

#include <memory>
#include <vector>

#include "mesh/tetrahedra/tetrahedral_mesh.h"
#include "solver/forces/soft.h"

namespace drape {

// A quarter of every tetrahedron to each of its vertices [kg].
std::vector<double> masses(const TetrahedralMesh& mesh, const SoftMaterial& material);

// The springs and the damping of a body whose vertex 0 is the particle `first_particle`. Throws InputError
// when the material has no Young's modulus: the edges of a mesh have no kinds.
std::vector<std::unique_ptr<Force>> soft_body(const TetrahedralMesh& mesh, const SoftMaterial& material,
                                              int first_particle = 0);

}  // namespace drape
