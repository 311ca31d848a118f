#include "solver/forces/buckling_spring.h"

#include "solver/forces/buckling_series.h"

namespace drape {

Buckling immediate_buckling(double delta) {
  double y, force, stiffness;
  internal::find_buckling(delta, y, force, stiffness);
  return {2 * y, force, stiffness};
}

double buckling_energy(double delta) {
  double y;
  internal::find_squared_angle(delta, y);
  return 2 * y;
}

double clamp_crossing(double c_hat) {
  constexpr double four_pi_squared = 39.478417604357434;
  if (!(c_hat > four_pi_squared)) return 1;
  double low = 0, high = 1;  // c_hat delta + force(delta) is < 0 at low and > 0 at high
  for (double mid = 0.5; low < mid && mid < high; mid = 0.5 * (low + high))
    (c_hat * mid + immediate_buckling(mid).force < 0 ? low : high) = mid;
  return high;
}

BucklingSpring::Rest BucklingSpring::rest(double L, double k_b, double c_b) {
  const double crossing = clamp_crossing(c_b * L * L * L / k_b), linear = crossing * L;
  return {L, k_b, c_b, crossing, 0.5 * c_b * linear * linear - k_b / L * buckling_energy(crossing)};
}

double BucklingSpring::energy(const Rest& r, double l) {
  const double delta = (r.L - l) / r.L;
  if (delta <= 0) return 0;
  if (delta <= r.crossing) return 0.5 * r.c_b * (r.L - l) * (r.L - l);
  return r.offset + r.k_b / r.L * buckling_energy(delta);
}

}  // namespace drape
