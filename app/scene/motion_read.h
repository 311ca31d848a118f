// The key `motion` of an obstacle or a pin; docs/scene.md lists its keys.
#pragma once

#include <filesystem>
#include <optional>

#include "app/base/table.h"
#include "app/scene/scene.h"
#include "constraints/motion.h"

namespace drape {

// Nothing when the table has no such key. `default_centre` [m]: what it turns about where no other is given.
// `source` becomes how it was given.
std::optional<Motion> read_motion(Table& table, const std::filesystem::path& folder,
                                  const Vec3& default_centre, MotionSource& source);

Vec3 read_spin(Table& table);  // `spin = { axis, rate }` [rad/s], zero when absent

}  // namespace drape
