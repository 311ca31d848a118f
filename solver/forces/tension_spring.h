// The connection along an edge: a spring that goes slack instead of pushing.            [Noh & Jung, eq. 5-8]
//   E(l) = k/2 (l - L)^2   l >= L,   0 otherwise
//   t    = k (l - L)
// k [N/m], L [m]. A pair within round-off of its rest length counts as taut, so that a sheet at rest resists
// at once. A spring with L = 0 is a weld: it pulls two particles together until they coincide.
#pragma once

#include "solver/forces/pair_force.h"

namespace drape {

struct TensionSpring {
  static constexpr const char* name = "stretch";
  static constexpr bool link_pushes = false;
  struct Rest {
    double L;  // m
    double k;  // N/m
  };

  static bool goes_slack(const Rest& r) { return r.L > 0; }
  static bool taut(const Rest& r, double l) { return l >= r.L * (1 - 1e-12); }
  static double energy(const Rest& r, double l) { return taut(r, l) ? 0.5 * r.k * (l - r.L) * (l - r.L) : 0; }
  static Tension tension(const Rest& r, double l) {
    return taut(r, l) ? Tension{r.k * (l - r.L), r.k} : Tension{0, 0};
  }
  static double chord(const Rest&, double) { return 0; }
  static double stiffest(const Rest& r, double) { return r.k; }
  static void relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep, Vec3* impulses);
};

}  // namespace drape
