// Reads the key `motion` of an obstacle or a pin; docs/scene.md lists the keys within it.
#pragma once

#include <filesystem>
#include <optional>

#include "app/base/table.h"
#include "app/scene/scene.h"
#include "constraints/motion.h"

namespace drape::app {

// Empty when the table has no such key. default_centre [m] is the centre of rotation when the motion gives
// none. `source` receives how the motion was given.
std::optional<Motion> read_motion(Table& table, const std::filesystem::path& folder,
                                  const Vec3& default_centre, MotionSource& source);

Vec3 read_spin(Table& table);  // the key `spin = { axis, rate }` as a vector, rad/s; zero when absent

}  // namespace drape::app
