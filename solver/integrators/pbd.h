// The position-based family, as the integrator "pbd". A step is cut into substeps of h:
//   v* = v + h g,   x = x_start + h v*                          where the particles would go
//   every element of every force in turn, some times over:      x changes as if that element were alone
//   bodies                                                      x and v change as if only the contact were there
//   v = (x - x_start) / h
// solver/forces/substep.h has what an element does: with the stiffness of the fabric by default, so that N/m
// means what it means to every other integrator, or as a link without stiffness. Elements of a force that
// share no particle are taken at the same time (solver/forces/colours.h). With many iterations this is
// implicit Euler of h; with few of them the cloth stretches more than its stiffness says, and the report's
// residual says how far that is: what is left of
//   M (v - v*) - h f(x, v) - impulses of contact,   relative to h |m g|
// where friction of cloth on cloth is bounded by the push of the substep before.
// Many substeps of one iteration do better than few of many.                  [Macklin et al. 2019, Small steps]
//                                            [Muller et al. 2007; Macklin, Muller & Chentanez 2016; Bullet's soft bodies]
// Contact is that of explicit methods: "velocity" or "restitution" (constraints/response.h). What it has
// moved a particle by is taken off again before the next iteration's contact, so that the contact is another
// element that is taken in turn. Pins have no mobility. One that a body with mass carries has a bound of the
// body's own where it is held, the trace of 1/m - [r] I^-1 [r] less 2/m, and its impulse goes to the body.
// x [m], v [m/s], M [kg], f [N], h [s].
#pragma once

#include <optional>

#include "solver/forces/cluster_contacts.h"
#include "solver/integrators/integrator.h"

namespace drape::internal {

class Pbd final : public Integrator {
 public:
  // Throws InputError when a force has no form for this, or an option makes no sense.
  Pbd(System& system, Constraints& constraints, const StepOptions& options, ContactMode contact);

  std::string_view name() const override { return "pbd"; }
  StepReport advance(State& state, double h) override;

 private:
  void take(State& state, double h, bool last, StepReport& report);
  void hold(const State& state, double h);
  void predict(const State& state, double h);
  void project(const State& state, double h, int iteration, StepReport& report);
  void pull_bodies(double h);
  void meet_bodies(const State& state, double h);
  bool responds() const;
  bool is_carried(int particle) const;
  double residual(const State& state, double h);

  System& system_;
  Constraints& constraints_;
  StepOptions options_;
  ContactMode contact_;
  std::optional<ContactStep> contacts_;  // of the substep under way
  Filter held_;
  std::vector<double> mobility_;  // 1/kg
  State before_;                  // the step
  VecX predicted_;                // x + h v* [m]
  VecX x_, v_;                    // at the end of the substep
  VecX moved_;                    // by contact with bodies in this substep [m]
  VecX pulled_;                   // on each pin, see ContactStep::respond [N s]
  ClusterContacts clusters_;      // of particles that are pushed as one
  std::vector<Vec3> carried_;     // where bodies and motions take the pins that move, in their order [m]
  VecX free_, free_v_, push_;     // scratch
};

}  // namespace drape::internal
