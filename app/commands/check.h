// `drape check`: what is in a scene or a mesh, in words; changes nothing.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/obj/examine.h"

namespace drape {

int check_file(const std::filesystem::path& file);

void print_report(const std::string& name, const MeshReport& report);

}  // namespace drape
