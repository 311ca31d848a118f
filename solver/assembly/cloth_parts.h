// What an Assembly makes of a cloth.
// Internal to the library's solver.
#pragma once

#include <vector>

#include "solver/assembly/cloth.h"

namespace drape::internal {

// The cloth's triangles between its particles, numbered from its first particle. Each particle is where its
// first vertex starts.
TriangleMesh between_particles(const Cloth& cloth);

std::vector<double> cloth_masses(const Cloth& cloth);  // kg, of its vertices, by its triangles

// What makes a cloth one that may tear as the part says. The cloth has its mesh and its edges. Throws
// InputError where it cannot tear, or would do so at once.
Tearing tearing_of(const ClothPart& part, const Cloth& cloth);

}  // namespace drape::internal
