// Explicit Runge-Kutta methods as their tableaux: "explicit-euler", "symplectic-euler", "midpoint",
// "sb-implicit", "rk4".
//   X_i = x + h sum_j a_ij V_j,  V_i = v + h sum_j a_ij A_j,  A_i = M^-1 f(X_i, V_i)
//   x' = x + h sum_i b_i V_i,    v' = v + h sum_i b_i A_i
// Symplectic Euler is a pair of tableaux, of which the second is implicit in form only: x' = x + h v'.
// What SB call implicit Euler evaluates the forces once more, where explicit Euler ends: "sb-implicit", which
// is explicit: 1 + z + z^2 is what a vibration grows by in a step.
//   Stable on an undamped vibration of frequency w [1/s] for h < 2/w (symplectic Euler), 2.8284/w (rk4), 1/w
//   (sb-implicit); explicit Euler and midpoint for no h.                    [Hairer, Norsett & Wanner, II.1;
//   Hairer,
//                                                             Lubich & Wanner, I.1]
// Pins, contact and friction: solver/integrators/held_motion.h. A state that is not finite is a failure, and so is one
// with a kinetic energy a thousand times all the energy that the motion was ever given: what it had at its
// start, and all that gravity, held particles that move, contact, and changes from outside have added since,
// with nothing taken off. A sound motion has no more than that, and the thousand leaves room for what a
// scheme errs by: the energy of symplectic Euler swings by (1 + hw/2) / (1 - hw/2), a hundred at 0.98 of its
// limit. It is not tried again in halves, because an unstable method would come back with one step later.
// x [m], v [m/s], M [kg], f [N], h [s].
#pragma once

#include <array>

#include "solver/integrators/held_motion.h"

namespace drape {

struct Tableau {
  std::string_view name, summary;
  int stages;
  std::array<std::array<double, 3>, 4> a;  // row i: what stage i takes of the stages before it
  std::array<double, 4> b;
  bool positions_last = false;  // x' = x + h v'
};

// All that are known.
const std::vector<Tableau>& tableaux();

class Explicit final : public Integrator {
 public:
  Explicit(const Tableau& tableau, System& system, Constraints& constraints, const StepOptions& options,
           ContactMode contact);

  std::string_view name() const override { return tableau_.name; }
  StepReport advance(State& state, double h) override;
  void count_given(double energy) override { given_ += energy; }

 private:
  void count_given(const State& state);
  bool explodes(double h) const;
  StepFailure explosion() const;

  Tableau tableau_;
  System& system_;
  HeldMotion motion_;
  StepOptions options_;
  std::array<VecX, 4> V_, A_;
  VecX x_, v_;        // at the end of a step, before contact; empty: there is no step to go on from
  double given_ = 0;  // J, all the energy that the motion was ever given
};

}  // namespace drape
