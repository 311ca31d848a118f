// A force pushes on particles. It is const during a step, once it is bound to the matrix; what it knows of
// the past changes at the end of a step.
//   f = -dE/dx (+ damping),  K = -df/dx (positive semidefinite part),  D = -df/dv
// Vectors are in the order of the particles, 3 numbers for each; the matrix is in row order
// (solver/matrix/block_matrix.h).
#pragma once

#include <string_view>
#include <vector>

#include "solver/forces/substep.h"
#include "solver/matrix/block_matrix.h"

namespace drape {

class Clusters;

// What damping slows: all relative motion, or only that along the connection (solver/forces/damping.h).
enum class DampingKind { relative, axial };

// Which stiffness K an implicit step uses.
enum class Stiffness {
  tangent,  // the positive semidefinite part of -df/dx at the current positions
  // A stiffer K where a force falls off on the way to the rest length, so that a step does not overshoot that
  // length.
  chord,
  // A K that also contains the stiffness that slack connections will have once they are taut: Newton's
  // iteration is slower, but a connection that becomes taut never surprises it.
  majorant,
};

// What a force learns before a step.
struct StepStart {
  double t, h;    // s
  const VecX& x;  // m, at t
  const VecX& v;  // m/s
  // How long after t is best for what a force takes from x and v and keeps for the whole step [s]: the end of
  // an implicit step, the middle of the others.
  double ahead = 0;
};

class Force {
 public:
  virtual ~Force() = default;
  virtual std::string_view name() const = 0;
  // True for the springs of contact, of cloth with bodies and of cloth with cloth. The energy that they store
  // is counted apart.
  virtual bool from_contact() const { return false; }

  // True for the springs of a cloth that resist nothing until they are taut. Where a system has any, a step
  // may overshoot (solver/integrators/merit.h).
  virtual bool goes_slack() const { return false; }
  // Lists the pairs of particles that act on each other as long as the force exists: its off-diagonal blocks.
  virtual void list_pairs(std::vector<ParticlePair>& pairs) const = 0;
  // Whether the force has stencils that come and go.
  virtual bool changes() const { return false; }
  // Finds those stencils for a step. Returns true when they differ from those of the last step.
  virtual bool begin_step(const StepStart&) { return false; }
  // Takes up what the step did that has ended at x: of a force that knows the past, such as dry friction.
  virtual void end_step(const VecX& /*x*/) {}
  // Keeps what the force knows of the past, and goes back to what was kept last.
  virtual void keep() {}
  virtual void go_back() {}
  // Lists the pairs of the stencils that come and go.
  virtual void list_changing_pairs(std::vector<ParticlePair>&) const {}
  // Remembers where the blocks of the force are in matrices of this layout.
  virtual void bind(const BlockLayout& layout) = 0;

  // All functions below are pure functions of x and v, given the stencils of the step and the past.
  virtual double energy(const VecX& x) const = 0;  // J
  // How far round-off may take that energy from what it is, where it is a sum of terms that cancel [J].
  virtual double energy_noise(const VecX& /*x*/) const { return 0; }
  // A convex function of v, whose slope is the force that depends on v: -dP/dv [W]. Where that force is
  // linear it is v . D v / 2.
  virtual double dissipation(const VecX& /*x*/, const VecX& /*v*/) const { return 0; }
  // The power that what is outside of the system gives by this force, such as the wind; never negative [W].
  virtual double given_power(const VecX& /*x*/, const VecX& /*v*/) const { return 0; }
  virtual void add_force(const VecX& x, const VecX& v, VecX& f) const = 0;  // f += force [N]
  // Adds this force to the two sides of an implicit step, linearised at (x, v):
  //   A += c D + c^2 K,  b += c (f - K y).        solver/integrators/bdf.h explains c [s] and y [m].
  virtual void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                              BlockMatrix& A, VecX& b) const = 0;

  // In a substep of the integrator "pbd" (solver/forces/substep.h):
  virtual bool projects() const { return false; }  // whether it has a form for this
  // True when it has no stiffness for the matrix of an implicit step, so that add_linearised() leaves it out.
  virtual bool only_projects() const { return false; }
  // To be called when a substep begins, after begin_step().
  virtual void begin_substep(int /*particles*/) {}
  // Takes every element in turn, once.
  virtual void project(Substep&) {}
  // The sets of its particles that are pushed as one where they touch (solver/forces/cluster_contacts.h);
  // null: each particle is on its own.
  virtual const Clusters* clusters() const { return nullptr; }
};

}  // namespace drape
