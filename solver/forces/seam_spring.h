// A stitch that closes: a spring whose rest length shrinks from the distance at the start to zero.
//   E(l) = k/2 (l - L(t))^2   l >= L(t),   0 otherwise
//   L(t) = L_0 (1 - s),  s = u^2 (3 - 2 u),  u = t / T within [0, 1]
// k [N/m] is the stiffness, L_0 [m] the distance at the start, T [s] the time that the seam takes to close.
// Within a step L has its value at the end of the step. A closed seam is a weld (a TensionSpring with L = 0):
// a load holds the two particles apart by tension / k.
#pragma once

#include <algorithm>

#include "solver/forces/tension_spring.h"

namespace drape {

struct SeamSpring {
  static constexpr const char* name = "seam";
  static constexpr bool link_pushes = false;
  struct Rest : TensionSpring::Rest {
    double L_0;  // m
  };

  // The ratio L / L_0 at a time t [s] for a seam that closes in T [s].
  static double open(double t, double T) {
    const double u = T > 0 ? std::clamp(t / T, 0.0, 1.0) : 1;
    return u < 1 ? 1 - u * u * (3 - 2 * u) : 0;
  }
  static double energy(const Rest& r, double l) { return TensionSpring::energy(r, l); }
  static Tension tension(const Rest& r, double l) { return TensionSpring::tension(r, l); }
  static double chord(const Rest& r, double l) { return TensionSpring::chord(r, l); }
  static double stiffest(const Rest& r, double l) { return TensionSpring::stiffest(r, l); }
};

}  // namespace drape
