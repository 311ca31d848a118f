// Where the warp of a woven cloth runs: the key `warp` of [[cloth]].
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Sets cloth.warp, cloth.warp_is_down and cloth.group_warps. The model and rest_is_flat have been read.
void read_warp(Table& table, ClothEntry& cloth);
// A scene that names a model of springs may keep keys of woven cloth, which are then idle. One that names no
// model has forgotten to, and is refused.
void take_with_woven(const Table& table, ClothEntry& cloth, const char* key);

}  // namespace drape::app
