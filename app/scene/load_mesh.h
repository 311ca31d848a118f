// Loads the meshes that a scene names: reads, places and examines them.
#pragma once

#include <filesystem>
#include <string>

#include "app/scene/scene.h"
#include "mesh/obj/examine.h"

namespace drape::app {

// Throws InputError when `where` is a place in a scene file ("scene.toml:12") and there is no file `path`.
void require_file(const std::filesystem::path& path, const std::string& where);

// Reads, places and examines a mesh. `where` is the place in the scene file that names it.
TriangleMesh load_mesh(const std::filesystem::path& path, const std::string& where,
                       const Placement& placement, MeshReport& report, Names& messages);

// Throws InputError when a vertex is placed beyond the range of numbers; `name` stands in the message.
TriangleMesh placed(TriangleMesh mesh, const Placement& placement, const std::string& name);

// Adds the defects of a mesh as messages with its name: "warning: sheet.obj: ...". Throws InputError when one
// of them is a refusal.
void add_messages(const MeshReport& report, const std::string& name, Names& messages);

}  // namespace drape::app
