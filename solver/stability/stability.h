// How long a step may be: of explicit methods from the frequencies of a system, in theory.
//   x'' = -M^-1 K x - M^-1 D x',  K = -df/dx, D = -df/dv at a state; of a mode u with |u|_M = 1:
//   a Mode: omega^2 = u . K u [1/s^2], d = u . D u [1/s], what its vibration x'' = -omega^2 x - d x' has
//   amplification  the larger |eigenvalue| of the 2 x 2 matrix that one step of the method multiplies (x, v)
//                  of a mode with
//   step_limit     the longest h up to which it is at most 1; 0 where no step is short enough
//     undamped: 2/omega for symplectic Euler, 2.8284/omega for rk4, 1/omega for sb-implicit, none for
//     explicit Euler and midpoint; explicit Euler with d < 2 omega: d/omega^2     [Hairer & Wanner 1996, IV.2]
// The modes are eigenvectors of K by Lanczos' method (Spectra, in stiffest_modes.cpp). Where D is a multiple
// of K (springs of one strength, one damping) they are those of the motion, and the limit is exact; else
// `proportional` is false and each has the damping that its own shape feels.
#pragma once

#include "constraints/constraints.h"
#include "solver/integrators/explicit.h"
#include "solver/system/system.h"

namespace drape {

struct Mode {
  double omega2;  // 1/s^2
  double d;       // 1/s
};

double amplification(const Tableau& tableau, const Mode& mode, double h);
double step_limit(const Tableau& tableau, const Mode& mode);  // s

struct Spectrum {
  std::vector<Mode> modes;   // the stiffest first; empty: nothing vibrates
  bool proportional = true;  // D = beta K
  double omega() const;      // 1/s, the highest frequency; 0: nothing vibrates
};

// The stiffest modes at a state with the constraints' pins held: at most so many. K is the majorant stiffness
// of solver/forces/force.h, so that what is slack counts as taut. Throws std::runtime_error where Lanczos' method
// does not converge.
Spectrum stiffest_modes(System& system, const Constraints& constraints, const State& state, int count = 6);

// The least of the limits of its modes; infinite without any.
double step_limit(const Tableau& tableau, const Spectrum& spectrum);

}  // namespace drape
