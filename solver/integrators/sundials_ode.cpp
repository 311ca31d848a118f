// "cvode-bdf", "cvode-adams", "arkode-erk", "arkode-dirk": SUNDIALS solves dx/dt = v, dv/dt = S M^-1 f(x, v)
// with inner steps of its own choice inside each h, so that the error of every inner step is below
//   e_x  in x,   e_v + relative_tolerance |v|  in v,    for each particle
//   e_x = share g / w^2,   e_v = share g / w,   w^2 = |D_ii / s + K_ii| / m_i,   unless they are given
// so e_x is a share of the length by which the weight of the particle stretches what holds it, and e_v is
// that at its stiffest vibration. (A share of |x| would depend on where the origin is, and lets the particles
// of a stiff cloth vibrate.)
// The methods of CVODE are kept to order 2, because those of higher order make energy of vibrations that
// nothing damps, at any tolerance that is not far below the vibrations themselves.
//                                                                             [Hairer & Wanner 1996, V.1]
// The implicit methods ask for (I - g J) (dx, dv) = (rx, rv) in Newton's iteration; that is our system,
//   (M + g D + g^2 K) dv = M rv - g K rx,   dx = rx + g dv,
// with the positive semidefinite K: Newton's iteration may need more rounds with it, but it ends at the same
// solution. Adams' formulas use no matrix (they iterate to a fixed point), nor does ERK: both need steps as
// short as the stiffest vibration asks for, and give up after max_inner_steps.
//                                                      [Hindmarsh et al. 2005; Reynolds et al. 2023]
// What bodies hold at the start of the step is held during it; solver/integrators/held_motion.h settles
// contact at its end. Where that changes the motion or what is held, SUNDIALS starts anew.
#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "mesh/base/stopwatch.h"
#include "solver/integrators/held_motion.h"
#include "solver/integrators/newton_matrix.h"
#include "solver/integrators/sundials_integrators.h"
#include "solver/linear/sundials.h"

namespace drape::internal {

namespace {

constexpr std::array<IntegratorInfo, 4> methods = {{
    {"cvode-bdf", "SUNDIALS CVODE, BDF 1 and 2, inner steps to a tolerance"},
    {"cvode-adams", "SUNDIALS CVODE, Adams 1 and 2, for soft cloth"},
    {"arkode-erk", "SUNDIALS ARKODE, explicit Runge-Kutta of order 4, for soft cloth"},
    {"arkode-dirk", "SUNDIALS ARKODE, diagonally implicit Runge-Kutta of order 4"},
}};

constexpr int most_order = 2;  // of the methods of CVODE
// Of the tolerances, also where there is no gravity.
constexpr double tolerance_share = 0.01, tolerance_gravity = 9.81;  // -, m/s^2

class SundialsOde final : public Integrator {
 public:
  SundialsOde(std::string_view name, System& system, Constraints& constraints,
              std::unique_ptr<LinearSolver> solver, const StepOptions& options);
  ~SundialsOde() override;

  std::string_view name() const override { return name_; }
  StepReport advance(State& state, double h) override;
  int solve_linear(N_Vector d, N_Vector r);

 private:
  static int derivative_of(double, N_Vector y, N_Vector dy, void* self) {
    return static_cast<SundialsOde*>(self)->derivative(y, dy);
  }
  static int weights_of(N_Vector y, N_Vector weights, void* self) {
    static_cast<SundialsOde*>(self)->weigh(y, weights);
    return 0;
  }
  int derivative(N_Vector y, N_Vector dy);
  void weigh(N_Vector y, N_Vector weights) const;
  void choose_tolerances(const State& state);
  void make_cvode(N_Vector y);
  void make_arkode(N_Vector y);
  void take_up(const State& state);
  int run(double until);
  int run(double until, bool one_step);
  bool same_held(const Filter& held) const;
  std::string why(int flag) const;
  void count();

  std::string_view name_;
  bool cvode_, implicit_;
  System& system_;
  HeldMotion motion_;
  StepOptions options_;
  sundials::Context context_;
  NewtonMatrix newton_;
  void* memory_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNNonlinearSolver fixed_point_ = nullptr;
  StepReport report_;
  double time_ = 0, reached_ = 0;               // on the clock of SUNDIALS [s]
  bool going_ = false;                          // SUNDIALS stands at the end of the last step
  Filter held_;                                 // what was held in the last step
  long steps_ = 0, rounds_ = 0, rejected_ = 0;  // counts of SUNDIALS up to the last step
  VecX tolerances_;                             // e_x and e_v, as y
  VecX y_, y_before_, x_, v_, a_, f_, b_, dv_;  // y = (x, v)
};

SundialsOde::SundialsOde(std::string_view name, System& system, Constraints& constraints,
                         std::unique_ptr<LinearSolver> solver, const StepOptions& options)
    : name_(name),
      cvode_(name.substr(0, 5) == "cvode"),
      implicit_(name == "cvode-bdf" || name == "arkode-dirk"),
      system_(system),
      motion_(system, constraints),
      options_(options),
      newton_(system, std::move(solver)) {
  const Eigen::Index n = 3 * system.particles();
  y_.setZero(2 * n);
  tolerances_.setOnes(2 * n);
  const sundials::View y(y_, context_);
  if (implicit_)
    linear_ = sundials::our_solver<SundialsOde, SUNLINEARSOLVER_MATRIX_EMBEDDED>(*this, context_);
  if (cvode_)
    make_cvode(y);
  else
    make_arkode(y);
}

void SundialsOde::make_cvode(N_Vector y) {
  memory_ = CVodeCreate(implicit_ ? CV_BDF : CV_ADAMS, context_);
  CVodeSetErrHandlerFn(memory_, sundials::say_nothing, nullptr);
  CVodeInit(memory_, derivative_of, 0, y);
  CVodeSetUserData(memory_, this);
  CVodeWFtolerances(memory_, weights_of);
  CVodeSetMaxNumSteps(memory_, options_.max_inner_steps);
  CVodeSetMaxOrd(memory_, most_order);
  if (implicit_) {
    CVodeSetLinearSolver(memory_, linear_, nullptr);
  } else {
    fixed_point_ = SUNNonlinSol_FixedPoint(y, 0, context_);
    CVodeSetNonlinearSolver(memory_, fixed_point_);
  }
}

void SundialsOde::make_arkode(N_Vector y) {
  memory_ =
      ARKStepCreate(implicit_ ? nullptr : derivative_of, implicit_ ? derivative_of : nullptr, 0, y, context_);
  ARKStepSetErrHandlerFn(memory_, sundials::say_nothing, nullptr);
  ARKStepSetUserData(memory_, this);
  ARKStepWFtolerances(memory_, weights_of);
  ARKStepSetMaxNumSteps(memory_, options_.max_inner_steps);
  ARKStepSetOrder(memory_, 4);
  if (implicit_) ARKStepSetLinearSolver(memory_, linear_, nullptr);
}

SundialsOde::~SundialsOde() {
  if (cvode_)
    CVodeFree(&memory_);
  else
    ARKStepFree(&memory_);
  if (linear_) SUNLinSolFreeEmpty(linear_);
  if (fixed_point_) SUNNonlinSolFree(fixed_point_);
}

StepReport SundialsOde::advance(State& state, double h) {
  check_step(system_, state, h);
  system_.bind();
  report_ = {};
  double step_ms = 0;
  {
    const Stopwatch watch(step_ms);
    const Eigen::Index n = state.x.size();
    motion_.begin(state, h, report_);
    if (newton_.follow_system()) choose_tolerances(state);
    take_up(state);
    const int flag = run(time_ + h);
    count();
    if (flag < 0) {
      going_ = false;
      report_.done = report_.converged = false;
      report_.failure = not_finite(system_, y_.head(n), y_.tail(n), why(flag));
    } else {
      time_ += h;
      x_ = y_.head(n);
      v_ = y_.tail(n);
      if (!motion_.finish(x_, v_, h, options_, state, report_)) {
        going_ = false;
        report_.failure.what +=
            "; what touches is settled once a step: take a shorter time step, or implicit-euler";
      }
    }
  }
  report_.step_ms = step_ms;
  return report_;
}

// The tolerances e_x and e_v of each particle. A particle that nothing holds gets the widest ones.
void SundialsOde::choose_tolerances(const State& state) {
  constexpr double widest_x = 1e-5, widest_v = 1e-3, least = 1e-12;  // m, m/s, and both
  constexpr double stretched = tolerance_share * tolerance_gravity;
  const Eigen::Index n = state.x.size();
  a_.setZero(n);
  b_.setZero(n);
  const std::vector<double> no_masses(system_.masses().size(), 0.0);
  newton_.assemble({state.x, a_, a_, 1, Stiffness::majorant}, no_masses, b_);  // of damping and stiffness
  const BlockMatrix& K = newton_.matrix();
  for (int i = 0; i < system_.particles(); ++i) {
    const double stiffness = K.at(K.pattern().diagonal(K.pattern().row_of()[i])).norm();
    const double w2 = stiffness / std::max(system_.masses()[i], 1e-300), w = std::sqrt(w2);
    const double e_x = w > 0 ? std::clamp(stretched / w2, least, widest_x) : widest_x;
    const double e_v = w > 0 ? std::clamp(stretched / w, least, widest_v) : widest_v;
    tolerances_.segment<3>(3 * i).setConstant(options_.absolute_tolerance_position.value_or(e_x));
    tolerances_.segment<3>(n + 3 * i).setConstant(options_.absolute_tolerance_velocity.value_or(e_v));
  }
}

void SundialsOde::weigh(N_Vector y, N_Vector weights) const {
  const Eigen::Index n = y_.size() / 2;
  const auto from = sundials::numbers(y);
  auto to = sundials::numbers(weights);
  to.head(n) = tolerances_.head(n).cwiseInverse();
  for (Eigen::Index i = n; i < 2 * n; i += 3) {
    const double error = tolerances_[i] + options_.relative_tolerance * from.segment<3>(i).norm();
    to.segment<3>(i).setConstant(1 / error);
  }
}

// Goes on from where SUNDIALS stands when the state is there and the same is held; otherwise starts anew.
void SundialsOde::take_up(const State& state) {
  const Eigen::Index n = state.x.size();
  if (going_ && y_.head(n) == state.x && y_.tail(n) == motion_.start_velocity() && same_held(motion_.held()))
    return;
  y_.head(n) = state.x;
  y_.tail(n) = motion_.start_velocity();
  held_ = motion_.held();
  const sundials::View y(y_, context_);
  time_ = reached_ = 0;
  if (cvode_) {
    CVodeReInit(memory_, 0, y);
    steps_ = rounds_ = rejected_ = 0;
  } else {
    ARKStepReset(memory_, 0, y);
  }
  going_ = true;
}

int SundialsOde::run(double until) {
  if (!motion_.counts()) return run(until, false);
  // Goes inner step by inner step, so that bodies get the impulses on faces and pins, by the trapezoidal
  // rule.
  const Eigen::Index n = y_.size() / 2;
  const auto count_half = [&](const VecX& y, double from) {
    x_ = y.head(n);
    v_ = y.tail(n);
    motion_.acceleration(x_, v_, a_);
    motion_.count((reached_ - from) / 2, x_, v_);
  };
  for (int step = 0; step < options_.max_inner_steps; ++step) {
    const double from = reached_;
    y_before_ = y_;
    if (const int flag = run(until, true); flag < 0) return flag;
    count_half(y_before_, from);
    count_half(y_, from);
    if (reached_ >= until) return 0;
  }
  return cvode_ ? CV_TOO_MUCH_WORK : ARK_TOO_MUCH_WORK;
}

int SundialsOde::run(double until, bool one_step) {
  const sundials::View y(y_, context_);
  if (cvode_) {
    CVodeSetStopTime(memory_, until);
    return CVode(memory_, until, y, &reached_, one_step ? CV_ONE_STEP : CV_NORMAL);
  }
  ARKStepSetStopTime(memory_, until);
  return ARKStepEvolve(memory_, until, y, &reached_, one_step ? ARK_ONE_STEP : ARK_NORMAL);
}

void SundialsOde::count() {
  long steps = 0, rounds = 0, rejected = 0;
  if (cvode_) {
    long not_solved = 0;
    CVodeGetNumSteps(memory_, &steps);
    CVodeGetNumErrTestFails(memory_, &rejected);
    CVodeGetNumStepSolveFails(memory_, &not_solved);
    rejected += not_solved;
    CVodeGetNumNonlinSolvIters(memory_, &rounds);
  } else {
    ARKStepGetNumSteps(memory_, &steps);
    ARKStepGetNumStepAttempts(memory_, &rejected);
    rejected -= steps;
    if (implicit_) ARKStepGetNumNonlinSolvIters(memory_, &rounds);
  }
  report_.inner_steps = static_cast<int>(steps - steps_);
  report_.newton_iterations = static_cast<int>(rounds - rounds_);
  report_.inner_rejected = static_cast<int>(rejected - rejected_);
  steps_ = steps;
  rounds_ = rounds;
  rejected_ = rejected;
}

bool SundialsOde::same_held(const Filter& held) const {
  const auto& a = held.entries();
  const auto& b = held_.entries();
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FilterEntry& p, const FilterEntry& q) {
    return p.particle == q.particle && p.S == q.S;
  });
}

int SundialsOde::derivative(N_Vector y, N_Vector dy) {
  const Stopwatch watch(report_.assemble_ms);
  const Eigen::Index n = y_.size() / 2;
  x_ = sundials::numbers(y).head(n);
  v_ = sundials::numbers(y).tail(n);
  motion_.acceleration(x_, v_, a_);
  sundials::numbers(dy).head(n) = v_;
  sundials::numbers(dy).tail(n) = a_;
  return a_.allFinite() ? 0 : 1;
}

int SundialsOde::solve_linear(N_Vector d, N_Vector r) {
  double now = 0, g = 0, factor = 0;
  N_Vector predicted = nullptr, y = nullptr, f = nullptr, other = nullptr;
  void* self = nullptr;
  if (cvode_)
    CVodeGetNonlinearSystemData(memory_, &now, &predicted, &y, &f, &g, &factor, &other, &self);
  else
    ARKStepGetNonlinearSystemData(memory_, &now, &predicted, &y, &f, &g, &other, &self);
  const Eigen::Index n = y_.size() / 2;
  const VecX rx = sundials::numbers(r).head(n);
  dv_ = sundials::numbers(r).tail(n);
  {
    const Stopwatch watch(report_.assemble_ms);
    x_ = sundials::numbers(y).head(n);
    v_ = sundials::numbers(y).tail(n);
    b_.setZero(n);
    newton_.assemble({x_, v_, rx, g, Stiffness::tangent}, system_.masses(), b_);  // g (f - K rx)
    f_.setZero(n);
    for (const auto& force : system_.forces()) force->add_force(x_, v_, f_);
    b_ -= g * f_;
    for (int i = 0; i < system_.particles(); ++i)
      b_.segment<3>(3 * i) += system_.masses()[i] * dv_.segment<3>(3 * i);
  }
  const Stopwatch watch(report_.solve_ms);
  Filter filter;  // in the locked directions dv = rv
  for (const FilterEntry& e : motion_.held().entries()) {
    const Vec3 rv = dv_.segment<3>(3 * e.particle);
    filter.constrain(e.particle, e.S, rv - e.S * rv);
  }
  const LinearReport linear =
      newton_.solve(b_, filter, {options_.tolerance, options_.max_linear_iterations, 0}, dv_);
  count_solve(linear, report_);
  report_.residual = std::max(report_.residual, linear.residual);
  sundials::numbers(d).tail(n) = dv_;
  sundials::numbers(d).head(n) = rx + g * dv_;
  return linear.reason == StopReason::converged ? 0 : 1;
}

std::string SundialsOde::why(int flag) const {
  const bool too_many = flag == (cvode_ ? CV_TOO_MUCH_WORK : ARK_TOO_MUCH_WORK);
  if (too_many && implicit_)
    return std::to_string(options_.max_inner_steps) +
           " inner steps did not reach the end of the step: take larger tolerances or a shorter time step";
  if (too_many)
    return std::to_string(options_.max_inner_steps) +
           " inner steps did not reach the end of the step: the cloth is stiff, take cvode-bdf or "
           "arkode-dirk";
  return sundials::taken(cvode_ ? CVodeGetReturnFlagName(flag) : ARKStepGetReturnFlagName(flag)) +
         " of SUNDIALS: take a shorter time step or other tolerances";
}

}  // namespace

std::vector<IntegratorInfo> sundials_ode_methods() { return {methods.begin(), methods.end()}; }

std::unique_ptr<Integrator> make_sundials_ode(std::string_view name, System& system, Constraints& constraints,
                                              std::unique_ptr<LinearSolver> solver,
                                              const StepOptions& options) {
  for (const IntegratorInfo& method : methods)
    if (method.name == name)
      return std::make_unique<SundialsOde>(method.name, system, constraints, std::move(solver), options);
  return nullptr;
}

}  // namespace drape::internal
