// Reads the [[soft]] tables of a scene file; docs/scene.md lists their keys.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Reads all keys but the name and the pins, which are read as those of a cloth.
SoftEntry read_soft(Table& table, const std::filesystem::path& folder);

}  // namespace drape::app
