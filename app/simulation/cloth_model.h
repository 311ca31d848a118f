// The masses and connections of a cloth in a scene, from its model, its fabric and its rest shape.
#pragma once

#include "app/scene/scene.h"
#include "solver/forces/connections.h"

namespace drape {

// Masses of the mesh's vertices, kg. `rest` is the rest shape as in solver/forces/noh_jung.h. Throws
// InputError when the model cannot be used on this mesh.
std::vector<double> cloth_masses(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest);

// The connections of the cloth. Adds to `messages` what the user should know. Throws
// InputError in the same case.
Connections cloth_connections(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                              Names& messages);

}  // namespace drape
