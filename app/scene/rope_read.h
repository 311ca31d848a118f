// The [[rope]] tables of a scene; docs/scene.md lists the keys.
#pragma once

#include <filesystem>

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// All but its name and its pins.
RopeEntry read_rope(Table& table, const std::filesystem::path& folder);

// Throws InputError when an end is anchored or joined twice, to a body that the scene does not have, or to a
// part that it does not have or that comes after the rope.
void check_ends(const RopeEntry& rope, const Scene& scene);

}  // namespace drape::app
