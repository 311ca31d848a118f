// How a cloth meets itself and others: the keys `self_contact`, `thickness` and `friction` of [[cloth]].
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Sets cloth.self_contact and cloth.self.
void read_self_contact(Table& table, ClothEntry& cloth);

}  // namespace drape::app
