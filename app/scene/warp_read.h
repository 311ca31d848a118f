// Where the warp of a woven cloth runs: the key `warp` of [[cloth]].
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Sets cloth.warp, cloth.warp_is_down and cloth.group_warps. The model and rest_is_flat have been read.
void read_warp(Table& table, ClothEntry& cloth);
// A scene that names a model of springs may keep what is of woven cloth: a note says what springs leave out. One that
// names none has forgotten to.
void refuse_with_springs(const Table& table, const ClothEntry& cloth, const char* key);

}  // namespace drape::app
