// A scene made ready to run: the meshes loaded and examined, one system for all cloths, their pins, and the
// obstacles.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "mesh/obj/examine.h"
#include "solver/assembly/assembly.h"

namespace drape::app {

// A mesh or level set of an obstacle as it was loaded, for `drape check`.
struct Body {
  std::string name;
  MeshReport report;      // of a mesh; for a level set from a .vdb file it has the box only
  std::string level_set;  // of a level set: its voxels and its error, in words
};

// A scene that is ready to run. Its parts are the cloths of the scene, followed by the soft bodies and the
// ropes.
struct Simulation : Assembly {
  using Assembly::Assembly;

  std::vector<Body> bodies;            // in the order of the scene's obstacles
  Names messages;                      // one line each, "warning: ..." or "note: ..."
  std::shared_ptr<const Scene> scene;  // the scene that it was made from
};

// Throws InputError when a mesh cannot be read or simulated, or when a pin selects nothing. keep_level_sets:
// whether a level set that had to be made is kept beside its mesh (app/scene/level_set_cache.h).
Simulation make_simulation(const Scene& scene, bool keep_level_sets = true);

}  // namespace drape::app
