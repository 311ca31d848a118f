// Volume, centre of mass and inertia of the solid that a closed surface bounds, for a density of 1.
//   V = sum det/6,   c = sum det/24 (a + b + c) / V,   det = a . (b x c);  a, b, c: the corners of a triangle
//   I = integral of |x - c|^2 1 - (x - c)(x - c)^T; for a tetrahedron 0 a b c: integral of x x^T =
//       det/120 (a a^T + b b^T + c c^T + s s^T),  s = a + b + c
// A surface that is wound inwards as a whole counts as the same solid. The inner wall of a hollow body is
// subtracted. A surface that is wound partly one way and partly the other is wound again, each piece outwards
// (mesh/distance/surface_faces.h). Equal triangles count once.
#pragma once

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct Solid {
  double volume;  // m^3
  Vec3 centre;    // m
  Mat3 inertia;   // m^5, about the centre; multiplied by a density [kg/m^3] it is in kg m^2
};

Solid solid_of(const TriangleMesh& surface);

}  // namespace drape
