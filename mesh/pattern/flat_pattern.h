// The flat pattern of a cloth: its rest shape, made from the texture coordinates of the OBJ file.
#pragma once

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// A mesh in the plane z = 0. Its triangle k is the given mesh's triangle k, corner by corner. Its vertices
// are the texture coordinates of the file times `scale` [m], so a vertex that lies in two panels occurs
// twice. Throws InputError when a face has no texture coordinates, or is a thousand times thinner in them
// than in space.
TriangleMesh flat_pattern(const TriangleMesh& mesh, double scale = 1);

}  // namespace drape
