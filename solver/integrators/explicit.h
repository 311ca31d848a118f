// Explicit Runge-Kutta methods as their tableaux: "explicit-euler", "symplectic-euler", "midpoint",
// "sb-implicit", "rk4".
//   X_i = x + h sum_j a_ij V_j,  V_i = v + h sum_j a_ij A_j,  A_i = M^-1 f(X_i, V_i)
//   x' = x + h sum_i b_i V_i,    v' = v + h sum_i b_i A_i
// Symplectic Euler is a pair of tableaux, of which the second is implicit in form only: x' = x + h v'.
// "sb-implicit" is what the report on a soft cube [SB] calls implicit Euler: it evaluates the forces a second
// time, at the point where explicit Euler ends. It is an explicit method: a vibration grows by 1 + z + z^2 in
// a step, with z the factor h times its eigenvalue.
//   On an undamped vibration of frequency w [1/s] symplectic Euler is stable for h < 2/w, rk4 for
//   h < 2.8284/w, sb-implicit for h < 1/w, explicit Euler and midpoint for no h.
//                                 [Hairer, Norsett & Wanner, II.1; Hairer, Lubich & Wanner, I.1]
// Pins, contact and friction: solver/integrators/held_motion.h.
// A state that is not finite is a failure. So is a state whose kinetic energy is a thousand times all the
// energy that the motion was ever given: what the motion had at its start, and all that gravity, held
// particles that move, contact, and changes from outside have added since, with nothing taken off. A sound
// motion has no more than that, and the factor of a thousand leaves room for the error of the scheme: the
// energy of symplectic Euler swings by (1 + hw/2) / (1 - hw/2), a factor of a hundred at 0.98 of its limit. A
// step that failed in this way is not tried again in halves, because an unstable method would fail again a
// step later.
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

// All tableaux, by name.
const std::vector<Tableau>& tableaux();

class Explicit final : public Integrator {
 public:
  Explicit(const Tableau& tableau, System& system, Constraints& constraints, const StepOptions& options,
           ContactMode contact);

  std::string_view name() const override { return tableau_.name; }
  StepReport advance(State& state, double h) override;
  void count_given(double energy) override { given_ += energy; }

 private:
  void take(State& state, double h, StepReport& report);  // one step
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
