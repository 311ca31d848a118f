// The [[obstacle]] tables of a scene file, and the keys that place a mesh; app/README.md lists them.
#pragma once

#include "app/scene.h"
#include "app/table.h"

namespace drape {

ObstacleEntry read_obstacle(Table& table, const std::filesystem::path& folder);

Mat3 read_rotation(Table& table);  // `rotate`
Placement read_placement(Table& table);
// A file named relative to the folder of the scene.
std::filesystem::path read_path(Table& table, const std::string& key, const std::filesystem::path& folder);

}  // namespace drape
