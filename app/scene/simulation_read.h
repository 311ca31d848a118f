// Reads the tables [simulation] and [air] of a scene.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

SimulationOptions read_simulation(const Table* given);  // null: the defaults
Air read_air(Table& table);

}  // namespace drape::app
