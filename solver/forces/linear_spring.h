// A spring that resists both ways, as in the lattices of soft bodies.                                  [SB]
//   E(l) = k/2 (l - L)^2,   t = k (l - L)
// k [N/m], L [m]. Under compression the stiffness along the spring stays, and the negative stiffness t/l
// across it is dropped (solver/forces/pair_force.h).
#pragma once

#include "solver/forces/pair_force.h"

namespace drape {

struct LinearSpring {
  static constexpr const char* name = "spring";
  static constexpr bool link_pushes = true;
  struct Rest {
    double L;  // m
    double k;  // N/m
  };

  static double energy(const Rest& r, double l) { return 0.5 * r.k * (l - r.L) * (l - r.L); }
  static Tension tension(const Rest& r, double l) { return {r.k * (l - r.L), r.k}; }
  static double chord(const Rest&, double) { return 0; }
  static double stiffest(const Rest& r, double) { return r.k; }
  static void relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep, Vec3* impulses);
};

}  // namespace drape
