// A triangle at rest, flat, in coordinates of its own: u along the warp and v along the weft.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace drape {

using RestCorners = std::array<Eigen::Vector2d, 3>;  // (u, v) [m]

// How the slopes dx/du and dx/dv of a linear function follow from its values at the corners.
struct RestSlopes {
  Eigen::Matrix<double, 3, 2> weights = Eigen::Matrix<double, 3, 2>::Zero();  // 1/m
  double area = 0;  // m^2; zero, and so are the weights, where the corners are on one line
};

inline RestSlopes slopes_of(const RestCorners& corners) {
  Eigen::Matrix2d edges;  // from corner 0 to 1 and to 2
  edges << corners[1] - corners[0], corners[2] - corners[0];
  const double twice = edges.determinant();
  const double longest = std::max(edges.colwise().norm().maxCoeff(), (corners[2] - corners[1]).norm());
  if (std::abs(twice) <= 1e-9 * longest * longest) return {};
  RestSlopes slopes;
  slopes.weights.bottomRows<2>() = edges.inverse();
  slopes.weights.row(0) = -slopes.weights.bottomRows<2>().colwise().sum();
  slopes.area = 0.5 * std::abs(twice);
  return slopes;
}

}  // namespace drape
