// The keys of an obstacle that moves by what acts on it: mass, inertia, velocity, spin.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape {

// Reads them into entry.rigid; the shape and the placement of the entry are read
// already. middle: of the shape.
void read_rigid(Table& table, ObstacleEntry& entry, const Vec3& middle);

}  // namespace drape
