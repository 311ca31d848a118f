// Does a body move as a whole?
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "app/export/source.h"

namespace drape {

struct RigidPlace {
  Vec3 centre;  // m
  Eigen::Quaterniond turn;
};

// Where the shape is in each frame: x = turn (X - centre of the first frame) + centre, X in the first frame.
// Empty when this does not give every vertex to a millionth of the shape's size, so when it deforms. A
// quaternion lies on the side of the one before it.
std::optional<std::vector<RigidPlace>> rigid_places(const ExportSource& source, std::size_t s);

}  // namespace drape
