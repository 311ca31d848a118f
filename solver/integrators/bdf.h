// The backward difference formulas of order 1 and 2 in one step: "implicit-euler" and "bdf2".
//   (M + c D + c^2 K) dv = M (v_bar - v) + c (f(x, v) - K y),   y = x_bar + c v - x,   c = gamma h
//   then v += dv, x = x_bar + c v.    K = -df/dx, D = -df/dv at the point of linearisation (x, v).
// gamma, x_bar and v_bar, which may differ between particles, are explained in
// solver/integrators/step_history.h.
// Order 1 linearises where the last state would come to if each piece went on as a rigid body
// (solver/integrators/rigid_motion.h): what turns would else be braked. Order 2 linearises at the velocity
// v_n + w (v_n - v_{n-1}) and at x_bar + c times that velocity: from the last state, one solve with a K that
// is not the exact one would be of first order only.
// The iteration is Newton's for the minimum of the incremental potential; solver/integrators/merit.h keeps it
// from ending above where it began. Contacts are settled within each of its solves
// (solver/integrators/contact_loop.h). A step that made energy goes on with two more iterations at most: what
// one solve leaves of a motion that bends or turns far in a step is energy that nothing brought. If one of
// order 2 still makes energy, it is taken again by order 1 (and counted in rescues). Such a step goes on with
// Newton's iteration until it makes none: what order 1 still makes of its own motion the scheme itself damps,
// but not what order 2 has kept alive.
// x [m], v [m/s], M [kg], f [N], h [s].
#pragma once

#include "solver/integrators/integrator.h"
#include "solver/integrators/merit.h"
#include "solver/integrators/newton_matrix.h"
#include "solver/integrators/rest_frame.h"
#include "solver/integrators/rigid_motion.h"
#include "solver/integrators/step_history.h"

namespace drape {

namespace internal {
class NewtonLoop;
}

class Bdf final : public Integrator {
 public:
  // Keeps references to the system and the constraints. `order` is 1 or 2.
  Bdf(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
      const StepOptions& options = {}, int order = 1);

  std::string_view name() const override { return history_.order() == 1 ? "implicit-euler" : "bdf2"; }
  // A step that fails (not finite, no convergence) is taken again in halves, those again in halves, and so
  // on, at most max_halvings times. So is one whose contacts do not settle, at most twice.
  StepReport advance(State& state, double h) override;

  StepOptions& options() { return options_; }
  // The matrix of the last solve, in row order, contact friction included.
  const BlockMatrix& matrix() const { return A_.matrix(); }

 private:
  class ContactSolve;

  bool attempt(State& state, const Piece& piece, StepReport& report);
  ContactStep begin(const State& state, const Piece& piece, StepReport& report);
  // Assembles all at (x, v); the same, and keeps what lasts; or only what comes and goes, after it was kept
  // there.
  enum class Assembly { all, keep, changing };
  void linearise(const State& state, Stiffness stiffness, const ContactStep& contacts, StepReport& report,
                 Assembly assembly);
  double residual(ContactStep& contacts);  // N s
  double residual_wanted() const;          // N s
  bool makes_energy(const State& start, const ContactStep& contacts, double h);
  void find_held(const State& state, const ContactStep& contacts);
  bool falls(ContactStep& contacts);  // whether the first solve of a step lowers Phi
  void set_base(ContactStep& contacts, bool at_rest);
  StepTaken descend(ContactStep& contacts, const internal::NewtonLoop& newton);
  void finish(State& state, ContactStep& contacts, StepReport& report);
  bool good(const LinearReport& linear) const;
  bool fail(StepReport& report, const std::string& what);

  const StepCoefficients& k() const { return history_.coefficients(); }
  bool falls_back() const { return history_.order() == 2 && !k().order_2(); }  // a step of order 1 in "bdf2"
  const std::vector<ContactFriction>& friction(ContactStep& contacts);
  void add_friction(const std::vector<ContactFriction>& friction);

  System& system_;
  Constraints& constraints_;
  StepOptions options_;
  StepHistory history_;
  NewtonMatrix A_;
  Merit merit_;
  RestFrame rest_frame_;
  RigidMotion rigid_;
  std::vector<char> held_;  // scratch: per particle, whether it is
  bool adrift_ =
      false;  // whether what only slides is at rest with its centre of mass, and not with what it slides on
  Point p_;   // the current point of Newton's iteration
  VecX dv_;   // m/s: before a solve its guess, afterwards its solution
  // What residuals are relative to at most [N s]. Where a step overshot that is what they were relative to
  // before, not the large forces there.
  double most_reference_ = 0;
  double imbalance_ = 0;  // of the contacts after the last solve, relative
  LinearReport linear_;   // of the last solve
  State before_;          // the state to which a step that fails half-way returns

  // Scratch of a step.
  Point end_;
  VecX y_, b_, b_rubbed_, v_base_, at_rest_, rest_, r_;
  Filter filter_;
  std::vector<ContactFriction> friction_;  // scaled as the rows are
};

// Implicit Euler, the step of Baraff & Witkin: order 1.
using ImplicitEuler = Bdf;

}  // namespace drape
