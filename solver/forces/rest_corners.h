// A triangle at rest, flat, in coordinates of its own: u along the warp and v along the weft.
#pragma once

#include <Eigen/Core>
#include <array>

namespace drape {

using RestCorners = std::array<Eigen::Vector2d, 3>;  // (u, v) [m]

// How the slopes dx/du and dx/dv of a linear function follow from its values at the corners.
struct RestSlopes {
  Eigen::Matrix<double, 3, 2> weights = Eigen::Matrix<double, 3, 2>::Zero();  // 1/m
  double area = 0;  // m^2; zero, and so are the weights, where the corners are on one line
};

RestSlopes slopes_of(const RestCorners& corners);

}  // namespace drape
