// Finds the panels and seams that a scene gives a cloth in the mesh of the cloth, and makes messages about
// them.
#pragma once

#include "app/scene/scene.h"
#include "solver/assembly/seam.h"

namespace drape::app {

// Places the panels. Throws InputError when a panel is no group of the mesh or shares a vertex with another
// one.
void place_panels(const ClothEntry& entry, TriangleMesh& mesh, Names& messages);

// Plans the seams. Throws InputError when a curve is missing or the two curves have different numbers of
// vertices.
std::vector<SeamPlan> seam_plans(const ClothEntry& entry, const TriangleMesh& mesh);

// Adds a message about a seam that gathers one of its curves.
void tell_of_gathers(const OpenSeam& seam, Names& messages);

}  // namespace drape::app
