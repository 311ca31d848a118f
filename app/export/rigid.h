// Finds out whether a body moves as a whole.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "app/export/source.h"

namespace drape::app {

struct RigidPlace {
  Vec3 centre;  // m
  Eigen::Quaterniond turn;
};

// The place of the shape in each frame: x = turn (X - centre of the first frame) + centre, with X the
// position in the first frame. Empty when this misses a vertex by more than a millionth of the shape's size,
// that is, when the shape deforms. The sign of each quaternion is chosen so that it is near the one before.
std::optional<std::vector<RigidPlace>> rigid_places(const ExportSource& source, std::size_t s);

}  // namespace drape::app
