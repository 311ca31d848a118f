// What a cloth of a scene is made of: masses and connections, by its model, fabric and rest shape.
#pragma once

#include "app/scene/scene.h"
#include "solver/forces/connections.h"

namespace drape {

// kg, of the mesh's vertices. `rest` as in solver/forces/noh_jung.h. Throws InputError when the mesh
// is not one for the model.
std::vector<double> cloth_masses(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest);

// Adds to the messages what the user should know. Throws InputError as above.
Connections cloth_connections(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                              Names& messages);

}  // namespace drape
