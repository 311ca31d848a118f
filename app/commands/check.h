// `drape check`: describes a scene or a mesh in words, and changes nothing of what is there.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/obj/examine.h"

namespace drape::app {

// Prints the description of a scene, a pattern or a mesh file, or of the folder of a run, and writes the
// sheets that cross into the new folder `mark` unless that is empty (crossings.h). Returns 0; throws
// InputError.
int check_file(const std::filesystem::path& file, const std::filesystem::path& mark);

// Prints counts, size and defects of a mesh; `name` stands in front.
void print_report(const std::string& name, const MeshReport& report);

}  // namespace drape::app
