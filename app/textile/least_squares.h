// The x at which a sum of squared residuals is least, by the method of Levenberg and Marquardt.        [More 1978]
// The residuals come from simulations and are rough: their slopes are differences over a long step.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace drape::app {

struct LeastSquares {
  Eigen::VectorXd x, residuals;
  Eigen::MatrixXd slopes;  // d residual / dx, of the last round
  int rounds = 0;          // how often the slopes were taken
  std::string ended;       // why it stopped, in words
};

// Residuals at x; false when they cannot be had there.
using Residuals = std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& residuals)>;

// Starts from x = 0. The x are logarithms. Slopes are differences over `step`, and the first step to a better
// x is no longer than 1. Stops when no step longer than 0.005 makes the sum smaller, when it becomes smaller
// by less than 1 part in 10 000, or after `most` evaluations. Throws std::runtime_error when there are no
// residuals at 0.
LeastSquares least_squares(const Residuals& residuals, int unknowns, int count, double step, int most);

}  // namespace drape::app
