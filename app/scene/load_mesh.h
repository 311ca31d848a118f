// The meshes that a scene names: read, placed and looked over.
#pragma once

#include <filesystem>
#include <string>

#include "app/scene/scene.h"
#include "mesh/obj/examine.h"

namespace drape {

void require_file(const std::filesystem::path& path, const std::string& where);

// Read, placed, looked over. where: stands before a file that is missing.
TriangleMesh load_mesh(const std::filesystem::path& path, const std::string& where,
                       const Placement& placement, MeshReport& report, Names& messages);

TriangleMesh placed(TriangleMesh mesh, const Placement& placement, const std::string& name);

// The defects of a mesh as messages with its name: "warning: sheet.obj: ...".
// Throws InputError when it is refused.
void add_messages(const MeshReport& report, const std::string& name, Names& messages);

}  // namespace drape
