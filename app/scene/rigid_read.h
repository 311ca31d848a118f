// Reads the keys of an obstacle that moves under the forces on it: mass, inertia, velocity, spin.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Sets entry.rigid when the table has a mass. The shape and the placement of the entry must have been read
// already. `middle` is the middle of the shape [m].
void read_rigid(Table& table, ObstacleEntry& entry, const Vec3& middle);

}  // namespace drape::app
