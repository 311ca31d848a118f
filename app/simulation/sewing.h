// The panels and seams that a scene gives a cloth, found in its mesh; what is said of them.
#pragma once

#include "app/scene/scene.h"
#include "solver/assembly/seam.h"

namespace drape::app {

// Throws InputError when a panel is no group of the mesh or shares a vertex with another one.
void place_panels(const ClothEntry& entry, TriangleMesh& mesh, Names& messages);

// Throws InputError when a curve is missing or two have different numbers of vertices.
std::vector<SeamPlan> seam_plans(const ClothEntry& entry, const TriangleMesh& mesh);

// Says what is gathered.
void tell_of_gathers(const OpenSeam& seam, Names& messages);

}  // namespace drape::app
