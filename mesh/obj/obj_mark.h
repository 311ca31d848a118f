// Marks faces of a mesh in its OBJ file, so that other programs can select them.
#pragma once

#include <string>
#include <vector>

#include "mesh/obj/obj.h"

namespace drape {

// The mesh's document, or for a mesh without one a document of its triangles, in which the faces of these
// triangles stand under a 'g' line of this name, and no more under the one that they stood under. Other faces
// that stood under the name do no more. All else is as it was.
ObjDocument with_group(const TriangleMesh& mesh, const std::vector<int>& triangles, const std::string& name);

}  // namespace drape
