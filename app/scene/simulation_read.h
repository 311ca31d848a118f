// Reads the tables [simulation] and [air] of a scene.
#pragma once

#include <optional>
#include <vector>

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

SimulationOptions read_simulation(const Table* given);  // null: the defaults
// `scene`: the table that the others stand in.
std::optional<Air> read_air(std::vector<Table> given, const Table& scene);

}  // namespace drape::app
