// The connections of a triangle mesh.                   [Noh & Jung, section 2; Choi & Ko 2002, eq. 9-13]
//   every edge      stretch  k_s = Y (A_1 + A_2) / l^2                          [Van Gelder 1998, eq. 4]
//   every diagonal  bend     k_b = B l L^3 / (6 h_1 h_2 (h_1 + h_2))            a beam of order 2
//     Y [N/m]: membrane stiffness per width; B [N m]: bending rigidity per width; l [m]: length of the edge;
//     A [m^2], h [m]: areas of the two triangles beside the edge, and their heights over it; L [m]: rest
//     length of the connection.
//   Or k_s and k_b are given and the same for every connection, as in the papers.
//   The clamp makes a connection limp below  kappa = sqrt(96 k_b / (c_b L h_1 h_2 (h_1 + h_2)^2)).
//
// The rest shape is a mesh of its own, whose triangle k is the cloth's triangle k, corner by corner. It may
// be cut where the cloth is sewn: there each side of an edge has its own rest length, which gives two springs
// side by side, and the diagonal across the edge has the rest length of the two triangles unfolded into a
// plane. The same holds where the rest shape is folded onto itself along the edge. Two sides of the same rest
// length count as one spring. An edge without length and a triangle without area give no bend connection.
#pragma once

#include "solver/forces/connections.h"

namespace drape {

// Throws InputError when a value of the fabric makes no sense (solver/forces/fabric.h).
Connections noh_jung_connections(const TriangleMesh& mesh, const TriangleMesh& rest, const Fabric& fabric);

// The masses of the vertices [kg]: lumped, and weighted by neighbours if the fabric says so.
std::vector<double> masses(const TriangleMesh& mesh, const Fabric& fabric);

// The stretch, bend and damping forces of a cloth that rests in the shape of the mesh. Vertex 0 is the
// particle `first_particle` of the system.
std::vector<std::unique_ptr<Force>> noh_jung(const TriangleMesh& mesh, const Fabric& fabric,
                                             int first_particle = 0);

}  // namespace drape
