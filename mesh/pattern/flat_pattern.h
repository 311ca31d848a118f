// The flat pattern of a cloth: its rest shape from the texture coordinates of the OBJ file.
#pragma once

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// A mesh in the plane z = 0 whose triangle k is the given mesh's triangle k, corner by corner; its vertices
// are the file's texture coordinates times `scale` [m]: a vertex that lies in two panels is there twice.
// Throws InputError when a face has no texture coordinates, or no area in them though it has one in space.
TriangleMesh flat_pattern(const TriangleMesh& mesh, double scale = 1);

}  // namespace drape
