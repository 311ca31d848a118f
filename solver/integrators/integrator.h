// An integrator takes State(t) to State(t + h). Its report is data: what the step cost, how well it went,
// where it failed.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "constraints/contact_step.h"
#include "solver/linear/linear_solver.h"
#include "solver/system/system.h"

namespace drape {

struct StepOptions {
  // The least number of linear solves in a step; 1 is Baraff & Witkin's step.
  int newton_iterations = 1;
  // The tolerance of the nonlinear residual, relative to h |m g|. When it is met, the step needs no more
  // iterations.
  double newton_tolerance = 1e-6;
  double tolerance = 1e-6;  // of the linear solve, see LinearOptions
  // The most iterations of a linear solve. 0: the size of the system gives the limit, and reaching it is a
  // failure. When a limit is given, the solve stops there, and the report says so.
  int max_linear_iterations = 0;
  std::optional<ContactMode> contact = {};  // unset: the mode that suits the integrator best
  // The contacts have settled when the impulses that are wrong (see ContactStep::imbalance) come to at most
  // this much, relative to h |m g| or to a larger impulse that acts. Unset: ten times `tolerance`.
  std::optional<double> contact_tolerance = {};
  // How often a step may be solved again because a contact changed. The count starts again for every motion
  // that is tried for a body that reacts.
  int max_contact_solves = 30;
  int max_rescues = 20;  // further Newton iterations when a full one would raise the incremental potential
  int max_halvings = 6;  // how often a failed step may be halved before it is given up
  // For the integrators with inner steps (cvode-, arkode-): the error of an inner step may be
  // absolute_tolerance_position in x, and absolute_tolerance_velocity plus relative_tolerance times |v| in v.
  // Unset: what suits the stiffness and mass of each particle (solver/integrators/sundials_ode.cpp).
  double relative_tolerance = 1e-4;
  std::optional<double> absolute_tolerance_position = {};  // m
  std::optional<double> absolute_tolerance_velocity = {};  // m/s
  int max_inner_steps = 5000;                              // most inner steps in a step; more is a failure
  ProjectionOptions projection = {};                       // of "pbd"
};

// Why and where a step failed.
struct StepFailure {
  std::string what;   // "the matrix is not positive definite", "not a finite number"
  int particle = -1;  // where the trouble is worst
  std::string force;  // the force that causes it, when that is known
};

inline double contact_tolerance(const StepOptions& options) {
  return options.contact_tolerance.value_or(10 * options.tolerance);
}

struct StepReport {
  bool done = true;           // false: the state is as before the step, but bodies that react may not be
  StepFailure failure;        // of a step that is not done
  int substeps = 1;           // pieces that the step was cut into, because it failed as a whole
  int inner_steps = 0;        // of the integrators that choose their inner steps
  int inner_rejected = 0;     // inner steps tried in vain: the error was too large, or nothing converged
  int newton_iterations = 0;  // this and the next counts are sums over the substeps
  int linear_solves = 0;
  int linear_iterations = 0;
  int multigrid_solves = 0;  // the solves for which the linear solver "auto" took ppcg+multigrid
  int rescues =
      0;  // iterations or steps taken again, because the potential rose, or of "bdf2" energy was made
  int guarded = 0;      // particles that were stopped at a surface outside the equations
  double residual = 0;  // relative: the worst of the solves that the substeps ended with
  bool converged =
      true;          // every solve reached its tolerance, the contacts have settled, and no piece stood still
  int contacts = 0;  // particles in contact at the end
  int self_contacts = 0;  // pairs of cloth and cloth that push each other at the end
  int self_guarded = 0;   // particles that were pushed or stopped so that no cloth passes through cloth
  int self_held = 0;      // of these, particles that were pushed aside only, and kept the rest of their way
  // Particles of pieces that stood still, at the cost of their momentum, since nothing else kept cloth from
  // passing through cloth.
  int stood_still = 0;
  int tangled = 0;  // particles where cloth passes through cloth, and is brought apart
  // Particles that a body may pass, because it could not be kept off them, or that two bodies, or two sides of
  // one, hold between them.
  int pinched = 0;
  int body_contacts = 0;        // points at which bodies press on each other at the end
  double body_overlap = 0;      // m: how far bodies were inside each other at the start
  double contact_residual = 0;  // how far they were from settled in the worst of the pieces, see StepOptions
  int torn = 0;                 // edges of cloth that were cut at the end (solver/assembly/tear_rule.h)
  // J: of the contacts in which the cloth gives way, at the end, before anything is cut or merged there and
  // they begin anew. An Assembly notes it.
  double contact_energy = 0;
  double penetration = 0;  // m: how far the deepest particle was inside a body at the start
  double assemble_ms = 0, solve_ms = 0, collide_ms = 0, step_ms = 0;
};

inline void count_solve(const LinearReport& linear, StepReport& report) {
  ++report.linear_solves;
  report.linear_iterations += linear.iterations;
  report.multigrid_solves += linear.method == "ppcg+multigrid";
}

// Takes over how far the contacts of a piece of the step are from settled.
inline void note_contacts(double imbalance, const StepOptions& options, StepReport& report) {
  report.contact_residual = std::max(report.contact_residual, imbalance);
  report.converged = report.converged && imbalance <= contact_tolerance(options);
}

inline bool settled(const StepReport& report, const StepOptions& options) {
  return report.contact_residual <= contact_tolerance(options);
}

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  virtual StepReport advance(State& state, double h) = 0;  // h [s]
  // Tells the integrator of energy [J] that came from outside since the last step without a change of the
  // state, because a force was changed.
  virtual void count_given(double /*energy*/) {}
};

// Throws InputError unless h is a time step and the state is one of the system, of finite numbers.
void check_step(const System& system, const State& state, double h);

// Lets the constraints end a step at x, v, which they may change, and notes in the report what they found.
void end_step(ContactStep& contacts, VecX& x, VecX& v, StepReport& report);

// Makes the integrator of that name, "implicit-euler" for example. Throws InputError for a name that
// integrators() does not list.
std::unique_ptr<Integrator> make_integrator(std::string_view name, System& system, Constraints& constraints,
                                            std::unique_ptr<LinearSolver> solver,
                                            const StepOptions& options = {});

// How the integrator of that name treats contact: as asked, or else in its own way. Throws InputError when it
// cannot do what was asked.
ContactMode contact_mode(std::string_view integrator, std::optional<ContactMode> asked);

struct IntegratorInfo {
  std::string_view name, summary;
};
std::vector<IntegratorInfo> integrators();  // those of this build
// Says that this build lacks the integrator of that name, and what to install for it; empty for any other
// name.
std::string missing_integrator(std::string_view name);

}  // namespace drape
