#include "app/textile/elastica.h"

#include <array>
#include <boost/math/tools/roots.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cmath>
#include <cstdint>

namespace drape::app {
namespace {

constexpr double right_angle = 1.57079632679489661923;

struct Shape {
  double gamma, chord_angle, droop;  // the droop as a share of the length
};

// The strip whose tip stands at phi_tip [rad] from the vertical. Followed from the tip in units of c, it
// obeys phi'' = t sin phi and ends where it is horizontal, phi = pi/2, at t = L / c = Gamma^(1/3).
Shape shape(double phi_tip) {
  using Values = std::array<double, 4>;  // phi, phi', and how far down and out the tip is
  const auto slope = [](const Values& y, Values& dy, double t) {
    dy = {y[1], t * std::sin(y[0]), std::cos(y[0]), std::sin(y[0])};
  };
  boost::numeric::odeint::runge_kutta4<Values> method;
  Values y = {phi_tip, 0, 0, 0};
  double t = 0;
  constexpr double step = 2e-3;
  while (y[0] < right_angle) {
    Values next = y;
    method.do_step(slope, next, t, step);
    if (next[0] >= right_angle) break;
    y = next;
    t += step;
  }
  for (int k = 0; k < 4; ++k) {  // Newton's method for the length of the last step
    const double rest = (right_angle - y[0]) / (y[1] > 0 ? y[1] : 1);
    method.do_step(slope, y, t, rest);
    t += rest;
  }
  return {t * t * t, std::atan2(y[2], y[3]), y[2] / t};
}

// Gamma of the shape of which `measure` is `value`; the measure grows from the level strip to the one that
// hangs.
double gamma_where(double Shape::*measure, double value) {
  const auto excess = [&](double phi_tip) { return shape(phi_tip).*measure - value; };
  std::uintmax_t most = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      excess, 1e-8, right_angle * (1 - 1e-9), boost::math::tools::eps_tolerance<double>(40), most);
  return shape(0.5 * (low + high)).gamma;
}

}  // namespace

double gamma_of_chord(double angle) { return gamma_where(&Shape::chord_angle, angle); }
double gamma_of_droop(double share) { return gamma_where(&Shape::droop, share); }

}  // namespace drape::app
