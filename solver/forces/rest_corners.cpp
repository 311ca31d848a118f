#include "solver/forces/rest_corners.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace drape {

RestSlopes slopes_of(const RestCorners& corners) {
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
