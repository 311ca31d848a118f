#include "app/textile/least_squares.h"

#include <Eigen/Dense>
#include <stdexcept>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace drape::app {
namespace {

// Eigen measures steps by their share of |x|. So its x is ours plus this.
constexpr double offset = 10;

struct Problem : Eigen::DenseFunctor<double> {
  const Residuals& residuals;
  double step;
  Eigen::VectorXd here;  // residuals at the x of the last slopes
  Eigen::MatrixXd slopes;
  int rounds = 0;

  Problem(const Residuals& of, int unknowns, int count, double step_)
      : Eigen::DenseFunctor<double>(unknowns, count), residuals(of), step(step_) {}

  bool at(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    r.resize(values());
    return residuals(x.array() - offset, r) && r.allFinite();
  }

  // Where there are no residuals, they are so large that no step leads there.
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    if (!at(x, r)) r.setConstant(1e6);
    return 0;
  }

  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& J) {
    Eigen::VectorXd there;
    at(x, here);
    J.setZero(values(), inputs());
    for (int k = 0; k < inputs(); ++k)
      for (const double h : {step, -step}) {
        Eigen::VectorXd moved = x;
        moved[k] += h;
        if (!at(moved, there)) continue;
        J.col(k) = (there - here) / h;
        break;
      }
    slopes = J;
    ++rounds;
    return inputs();
  }
};

std::string in_words(Eigen::LevenbergMarquardtSpace::Status status) {
  using namespace Eigen::LevenbergMarquardtSpace;
  switch (status) {
    case RelativeErrorTooSmall:
    case RelativeErrorAndReductionTooSmall:
    case XtolTooSmall:
      return "the last step changed the parameters by less than 0.5 %";
    case TooManyFunctionEvaluation:
      return "stopped after as many rounds as are allowed, not at the best parameters";
    default:
      return "the sum of squares became no smaller";
  }
}

}  // namespace

LeastSquares least_squares(const Residuals& residuals, int unknowns, int count, double step, int most) {
  Problem problem(residuals, unknowns, count, step);
  Eigen::LevenbergMarquardt<Problem> method(problem);
  method.setXtol(0.005 / offset);
  method.setFtol(1e-4);
  method.setFactor(1 / offset);
  method.setMaxfev(most);
  LeastSquares found;
  found.x = Eigen::VectorXd::Constant(unknowns, offset);
  if (Eigen::VectorXd r; !problem.at(found.x, r))
    throw std::runtime_error("a specimen did not come to rest with the parameters that the fit starts from");
  found.ended = in_words(method.minimize(found.x));
  problem.at(found.x, found.residuals);
  found.x.array() -= offset;
  found.slopes = problem.slopes;
  found.rounds = problem.rounds;
  return found;
}

}  // namespace drape::app
