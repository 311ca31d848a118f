// The connection across an edge: a beam that buckles at once into a circular arc.
//                                                      [Choi & Ko 2002, section 4; Noh & Jung, eq. 9-13]
//   sinc(u) = l/L,  u in [0, pi],  kappa = 2 u / L
//   E(l) = k_b L kappa^2 / 2 = 2 k_b u^2 / L
//   t(l) = dE/dl = (k_b / L^2) 4 u^2 / (cos u - sinc u)       negative: it pushes apart
//   t*   = max(t, c_b (l - L))       the clamp: linear in l from L down to where the two forces are equal
// k_b [N m^2], L [m], c_b [N/m].  For l >= L there is no force.
// The clamp takes the bending rigidity away below a curvature that solver/forces/noh_jung.h gives;
// solver/forces/connections.h chooses c_b. When c_b L^3 / k_b <= 4 pi^2 the force never leaves the clamp, and
// the connection is a linear spring throughout.
#pragma once

#include "solver/forces/pair_force.h"

namespace drape {

// The law in dimensionless numbers, at delta = 1 - l/L in [0, 1].
struct Buckling {
  double energy;     // E L / k_b    = 2 u^2
  double force;      // t L^2 / k_b
  double stiffness;  // dt/dl L^3 / k_b
};
Buckling immediate_buckling(double delta);

double buckling_energy(double delta);  // the energy alone

// The delta at which the clamp c_hat = c_b L^3 / k_b meets the buckling law: the root of
// c_hat delta = -force(delta). It is 1 when the connection never buckles.
double clamp_crossing(double c_hat);

struct BucklingSpring {
  static constexpr const char* name = "bend";
  struct Rest {
    double L;         // m
    double k_b;       // N m^2
    double c_b;       // N/m
    double crossing;  // clamp_crossing(c_b L^3 / k_b)
    double offset;    // J, by which the energy of the clamp at the crossing is above that of buckling
  };

  static Rest rest(double L, double k_b, double c_b);

  static double energy(const Rest& r, double l);
  static Tension tension(const Rest& r, double l) {
    const double delta = (r.L - l) / r.L;
    if (delta <= 0) return {0, 0};
    if (delta <= r.crossing) return {r.c_b * (l - r.L), r.c_b};
    const Buckling b = immediate_buckling(delta);
    return {r.k_b / (r.L * r.L) * b.force, r.k_b / (r.L * r.L * r.L) * b.stiffness};
  }
  // The force of a buckled connection hardly changes until the clamp takes it away at once. With the slope of
  // the force alone, a step shoots past the clamp and back, for ever. The chord to the rest length foresees
  // the clamp, and the parabola with the stiffness of the chord lies above the energy.
  static double chord(const Rest& r, double l) { return l < r.L ? tension(r, l).t / (l - r.L) : 0; }
  static double stiffest(const Rest& r, double l) { return l >= r.L && l < 1.02 * r.L ? r.c_b : chord(r, l); }
  static void relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep, Vec3* impulses);
};

}  // namespace drape
