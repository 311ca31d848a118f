// How long a step of an explicit method may be, computed from the frequencies of a system.
//   x'' = -M^-1 K x - M^-1 D x',  K = -df/dx, D = -df/dv at a state. A mode u with |u|_M = 1 has
//   Mode           omega^2 = u . K u [1/s^2] and d = u . D u [1/s] of its vibration x'' = -omega^2 x - d x'
//   amplification  the larger |eigenvalue| of the 2 x 2 matrix by which one step of the method multiplies
//                  (x, v) of a mode
//   step_limit     the longest h up to which the amplification is at most 1; 0 where no step is short enough
//     undamped: 2/omega for symplectic Euler, 2.8284/omega for rk4, 1/omega for sb-implicit, none for
//     explicit Euler and midpoint; explicit Euler with d < 2 omega: d/omega^2
//                                                                           [Hairer & Wanner 1996, IV.2]
// The modes are eigenvectors of K by Lanczos' method (Spectra, in stiffest_modes.cpp). Where D is a multiple
// of K (all springs of one stiffness and one damping) they are the modes of the motion, and the limit is
// exact. Otherwise `proportional` is false, and each mode has the damping that its own shape feels.
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
  std::vector<Mode> modes;   // the stiffest first; empty where nothing vibrates
  bool proportional = true;  // D is a multiple of K
  double omega() const;      // the highest frequency [1/s]; 0 where nothing vibrates
};

// Returns the stiffest modes at a state with the constraints' pins held, at most `count` of them. K is the
// majorant stiffness of solver/forces/force.h, so that slack springs count as taut. Throws std::runtime_error
// where Lanczos' method does not converge.
Spectrum stiffest_modes(System& system, const Constraints& constraints, const State& state, int count = 6);

// The least of the limits of the spectrum's modes; infinite where there are none.
double step_limit(const Tableau& tableau, const Spectrum& spectrum);

}  // namespace drape
