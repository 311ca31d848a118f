// `drape check`: describes a scene or a mesh in words, and changes nothing.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/obj/examine.h"

namespace drape::app {

// Prints the description of a scene, a pattern or a mesh file, or of the folder of a run. Returns 0; throws InputError.
int check_file(const std::filesystem::path& file);

// Prints counts, size and defects of a mesh; `name` stands in front.
void print_report(const std::string& name, const MeshReport& report);

}  // namespace drape::app
