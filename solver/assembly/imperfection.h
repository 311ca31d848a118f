// What keeps a cloth from being perfect. A cloth that is exactly flat and is pushed in its own plane has no
// reason to leave it to one side or to the other, and would stay in it under any load. So it starts a little
// off its surface, by
//   w(X) = amplitude / 4 sum_k sin(2 pi m_k d_k . (X - X_0) / L + phi_k),   k = 1 .. 4
// along the normal of every vertex. X [m] is where the vertex is in the rest shape, and X_0 and L [m] the
// lowest corner and the diagonal of that shape's box, so that w depends neither on the mesh nor on where the
// cloth is placed. Directions d_k, numbers of waves m_k (0.7 to 5 on the diagonal) and phases phi_k are fixed
// and share no symmetry with a sheet. Waves of 1 um on cloth of decimetres are strains of 1e-9 and curvatures
// of 1e-2 1/m.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

inline constexpr double woven_imperfection = 1e-6;  // m, where nothing else is said

// How far each vertex of the mesh is moved [m], by at most `amplitude` [m]. Triangle k of `rest` is triangle
// k of the mesh. A vertex whose triangles have no normal stays. Vertices at exactly the same place are moved
// together, along the sum of their normals, so that panels that are not joined do not begin through each
// other. Where these normals cancel they stay.
std::vector<Vec3> imperfection(const TriangleMesh& mesh, const TriangleMesh& rest, double amplitude);

}  // namespace drape
