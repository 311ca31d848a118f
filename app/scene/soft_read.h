// The [[soft]] tables of a scene file; docs/scene.md lists the keys.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape {

// All but its name and its pins, which are as a cloth's.
SoftEntry read_soft(Table& table, const std::filesystem::path& folder);

}  // namespace drape
