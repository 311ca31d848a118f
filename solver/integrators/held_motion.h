// Pins, contact and friction for integrators that follow dx/dt = v, dv/dt = M^-1 f and know no constraints.
//   begin     finds what touches. What that locks is held during the step: it starts
//             with its target velocity, v_0 = v_n + z, and has the acceleration S M^-1 f.
//   finish    solves the constrained step with the mass alone, particle by particle: from the velocity that
//             a particle would have had,
//               v_free = v_1 - z + integral of (I - S) M^-1 f over the step,
//             come the impulse that holds it, r = m (v - v_free) and friction, hence what is released, sticks
//             and slides (what is let go moves from the next step on); what touches moves to x = x_n +
//             correction + h v.      [constraints/contact.h]
//   So contact is of first order in h, whatever the method between; the rest keeps the method's order.
// With a contact mode other than "constraint" only pins are held: what touches a body moves freely, and
// finish changes where it went and how fast by the response of the body.      [constraints/response.h]
// x [m], v [m/s], h [s], f [N], r [N s].
#pragma once

#include <optional>

#include "constraints/contact_step.h"
#include "solver/integrators/integrator.h"

namespace drape {

class HeldMotion {
 public:
  HeldMotion(System& system, Constraints& constraints, ContactMode contact = ContactMode::constraint)
      : system_(system), constraints_(constraints), contact_(contact) {}

  void begin(const State& state, double h, StepReport& report);
  const VecX& start_velocity() const { return v_start_; }
  const Filter& held() const { return held_; }  // in particle order

  void acceleration(const VecX& x, const VecX& v, VecX& a);  // S M^-1 f
  double power() const { return power_; }  // W, that bodies and what holds particles gave to them there
  // The force at x, v, whose acceleration was asked for last, acts for so long [s], on bodies that react,
  // too.
  void count(double duration, const VecX& x, const VecX& v);
  bool counts() const;  // something is held by a body

  // State(t) -> State(t + h), when the method came from v_start to x, v. False, and why in the report, when
  // they are not finite, or do not agree with the bodies that react; the state is as it was then.
  bool finish(const VecX& x, const VecX& v, double h, const StepOptions& options, State& state,
              StepReport& report);

 private:
  class ContactSolve;

  double impulse_noise(double h) const;
  void set_free(const VecX& v);
  void move_within_constraints(const State& state, const VecX& x, double h);
  void let_go(const VecX& x, const VecX& v);

  System& system_;
  Constraints& constraints_;
  ContactMode contact_;
  std::optional<ContactStep> contacts_;  // of the step under way
  Filter held_, filter_;
  VecX v_start_, v_free_, x_new_, v_new_, r_;
  VecX pull_, pulled_;  // N, N s, of what holds particles, besides bringing them to their velocity
  double power_ = 0;
};

// Where x or v is not a finite number, and the force that is not either.
StepFailure not_finite(const System& system, const VecX& x, const VecX& v, const std::string& what);

}  // namespace drape
