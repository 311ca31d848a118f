// The [[obstacle]] tables of a scene file, and the keys that place a mesh; docs/scene.md lists them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

ObstacleEntry read_obstacle(Table& table, const std::filesystem::path& folder);

Vec3 middle(const ObstacleEntry& entry);  // m, the centre of rotation where the scene gives none

using Turns = std::vector<Eigen::AngleAxisd>;  // the first of them is applied first

Vec3 read_axis(Table& table);    // `axis`, required; of length 1
Turns read_turns(Table& table);  // `rotate`
Mat3 product(const Turns& turns);
Mat3 read_rotation(Table& table);        // `rotate`
Placement read_place(Table& table);      // `rotate` and `translate`
Placement read_placement(Table& table);  // `rotate`, `translate` and `scale`
// `mesh`, required: a file named relative to the folder of the scene.
std::filesystem::path read_path(Table& table, const std::filesystem::path& folder, const About& about);

}  // namespace drape::app
