// Pins, contact and friction for integrators that follow dx/dt = v, dv/dt = M^-1 f and have no constraints.
//   begin     finds what touches. The directions that this locks are held during the step: there a particle
//             starts with its target velocity, v_0 = v_n + z, and it has the acceleration S M^-1 f.
//   finish    solves the constrained step with the mass alone, particle by particle. The velocity that a
//             particle would have had without constraints is
//               v_free = v_1 - z + integral of (I - S) M^-1 f over the step.
//             From it follow friction and the impulse that holds the particle, r = m (v - v_free), and hence
//             what is released, sticks and slides (a particle that is let go moves from the next step on). A
//             particle that touches moves to x = x_n + correction + h v.      [constraints/contact.h]
//   So contact is of first order in h, whatever the method in between; the other particles keep the method's
//   order.
// With a contact mode other than "constraint" only pins are held: a particle that touches a body moves
// freely, and finish changes its place and velocity by the response of the body (constraints/response.h).
// x [m], v [m/s], h [s], f [N], r [N s].
#pragma once

#include <optional>

#include "constraints/contact_step.h"
#include "solver/integrators/integrator.h"

namespace drape {

class HeldMotion {
 public:
  // kappa: see constraints/self_contact.h.
  HeldMotion(System& system, Constraints& constraints, ContactMode contact = ContactMode::constraint,
             double kappa = implicit_kappa)
      : system_(system), constraints_(constraints), contact_(contact), kappa_(kappa) {}

  void begin(const State& state, double h, StepReport& report);
  const VecX& start_velocity() const { return v_start_; }
  const Filter& held() const { return held_; }  // in particle order

  void acceleration(const VecX& x, const VecX& v, VecX& a);  // S M^-1 f
  double power() const { return power_; }  // of bodies and pins at the last acceleration() [W]
  // Counts that the force at x, v acts for this duration [s], on bodies that react as well. The acceleration
  // at x, v must be the one that was asked for last.
  void count(double duration, const VecX& x, const VecX& v);
  bool counts() const;  // whether a body holds anything

  // Advances State(t) -> State(t + h) when the method came from v_start to x, v. Returns false when x and v
  // are not finite, or do not agree with the bodies that react; the report then says why, and the state is
  // unchanged.
  bool finish(const VecX& x, const VecX& v, double h, const StepOptions& options, State& state,
              StepReport& report);

 private:
  class ContactSolve;

  double impulse_noise(double h) const;
  double weight_impulse(double h) const;  // h |m g| [N s]
  void set_free(const VecX& v);
  void move_within_constraints(const State& state, const VecX& x, double h);
  void let_go(const VecX& x, const VecX& v, double h);

  System& system_;
  Constraints& constraints_;
  ContactMode contact_;
  double kappa_;
  std::optional<ContactStep> contacts_;  // of the step under way
  Filter held_, filter_;
  VecX v_start_, v_free_, x_new_, v_new_, r_;
  // The force [N], and its impulse [N s], that holds particles, besides the impulse that brings them to their
  // velocity.
  VecX pull_, pulled_;
  double power_ = 0;
};

// The failure of a step: the particle at which x or v is not finite, and the force that is not finite there.
StepFailure not_finite(const System& system, const VecX& x, const VecX& v, const std::string& what);

}  // namespace drape
