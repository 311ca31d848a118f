// What a cloth of a scene is made of: masses and connections, by its model, fabric and rest shape.
#pragma once

#include "app/scene.h"
#include "solver/connections.h"

namespace drape {

struct ClothModel {
  std::vector<double> masses;  // kg, of the mesh's vertices
  Connections connections;
};

// `rest` as in solver/noh_jung.h. Adds to the messages what the user should know. Throws InputError when the
// mesh is not one for the model.
ClothModel cloth_model(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                       Names& messages);

}  // namespace drape
