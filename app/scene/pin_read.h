// The `pins` tables of cloths, soft bodies and ropes; docs/scene.md lists the keys.
#pragma once

#include <filesystem>

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

inline constexpr const char* pins_about = "vertices that are held, or led";

enum class PinsOf { mesh, rope };  // a mesh has groups, a rope has ends

PinEntry read_pin(Table& pin, const std::filesystem::path& folder, PinsOf of = PinsOf::mesh);

// `end`, required: whether it is the last end of a rope, and not its first.
bool read_is_last(Table& table, const About& about);

// Throws InputError unless the scene has exactly one obstacle of this name, which stands at `where` under
// this key.
void check_obstacle(const std::string& where, const std::string& key, const std::string& name,
                    const std::vector<ObstacleEntry>& obstacles);
void check_follow(const PinEntry& pin, const std::vector<ObstacleEntry>& obstacles);

}  // namespace drape::app
