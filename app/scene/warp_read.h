// Where the warp of a woven cloth runs: the key `warp` of [[cloth]].
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Sets cloth.warp and cloth.group_warps. The model and rest_is_flat have been read.
void read_warp(Table& table, ClothEntry& cloth);

}  // namespace drape::app
