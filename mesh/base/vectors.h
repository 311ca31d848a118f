// The vector and matrix types of the whole project, in double precision.
#pragma once

#include <Eigen/Core>

namespace drape {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using VecX = Eigen::VectorXd;

}  // namespace drape
