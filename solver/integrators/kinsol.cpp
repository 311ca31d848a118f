// "newton-kinsol": the equation of implicit Euler, solved to newton_tolerance by KINSOL of SUNDIALS.
//   F(v) = S [ M (v - v_n) - h f(x_bar + h v, v) + friction ] = 0,   x_bar = x_n + correction,
//   v = its target in the locked directions;   Newton's direction: A dv = -F, A = M + h D + h^2 K at v;
//   KINSOL looks along it for a smaller |F|.                    [Dennis & Schnabel 1996, algorithm A6.3.1]
// |F| has false minima where edges go slack. Where the search ends in one, KINSOL goes on from there with
// directions that are halved until they lower the incremental potential Phi(v), of which F is the gradient
// with dampers as they are where a direction begins (solver/integrators/merit.h). (Searching by Phi from the
// start takes longer, because kinks keep its steps short.) After that K is replaced by the majorant; if that
// fails as well, the step is halved. When the contacts do not agree with the solution, they change and KINSOL
// begins again from it. x [m], v [m/s], M [kg], f [N], h [s], F [N s].
#include <kinsol/kinsol.h>
#include <kinsol/kinsol_ls.h>

#include <array>
#include <cmath>
#include <limits>

#include "mesh/base/parallel.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/contact_loop.h"
#include "solver/integrators/merit.h"
#include "solver/integrators/newton_matrix.h"
#include "solver/integrators/sundials_integrators.h"
#include "solver/linear/sundials.h"

namespace drape::internal {

namespace {

// How Newton's direction is found and how far it is followed.
struct Search {
  int strategy = KIN_LINESEARCH;  // of KINSOL, by |F|; KIN_NONE: halved by Phi
  Stiffness stiffness = Stiffness::tangent;
};

class NewtonKinsol final : public Integrator {
 public:
  NewtonKinsol(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
               const StepOptions& options)
      : system_(system), constraints_(constraints), options_(options), newton_(system, std::move(solver)) {
    const Eigen::Index n = 3 * system.particles();
    for (VecX* vector : {&x_, &x_bar_, &v_, &v_n_, &v_here_, &F_, &f_scale_, &b_, &one_, &dv_, &minus_F_})
      vector->setZero(n);
    one_.setOnes();
    sundials::View u(v_, context_);
    kinsol_ = KINCreate(context_);
    KINSetErrHandlerFn(kinsol_, sundials::say_nothing, nullptr);
    KINSetUserData(kinsol_, this);
    KINInit(
        kinsol_,
        [](N_Vector v, N_Vector F, void* self) { return static_cast<NewtonKinsol*>(self)->residual(v, F); },
        u);
    linear_ = sundials::our_solver<NewtonKinsol, SUNLINEARSOLVER_DIRECT>(*this, context_);
    matrix_ = SUNMatNewEmpty(context_);
    matrix_->ops->getid = [](SUNMatrix) { return SUNMATRIX_CUSTOM; };
    matrix_->ops->zero = [](SUNMatrix) { return 0; };
    KINSetLinearSolver(kinsol_, linear_, matrix_);
    KINSetJacFn(kinsol_, [](N_Vector v, N_Vector, SUNMatrix, void* self, N_Vector, N_Vector) {
      return static_cast<NewtonKinsol*>(self)->set_up(v);
    });
    KINSetMaxSetupCalls(kinsol_, 1);  // makes a new matrix for every direction
  }
  ~NewtonKinsol() override {
    KINFree(&kinsol_);
    SUNLinSolFreeEmpty(linear_);
    SUNMatFreeEmpty(matrix_);
  }

  std::string_view name() const override { return "newton-kinsol"; }
  StepReport advance(State& state, double h) override;
  int solve_linear(N_Vector dv, N_Vector minus_F);

 private:
  class ContactSolve;

  bool attempt(State& state, const Piece& piece);
  bool solve();
  int iterate(double wanted, double& norm);
  double step_length(const VecX& v, const VecX& dv, double slope);
  double potential(const VecX& v);
  void assemble(const VecX& v);
  void equation(const VecX& v);
  int residual(N_Vector v, N_Vector F);
  int set_up(N_Vector v);
  bool fail(const std::string& what);

  System& system_;
  Constraints& constraints_;
  std::optional<ContactStep> contacts_;  // those of the step under way
  StepOptions options_;
  sundials::Context context_;
  NewtonMatrix newton_;
  void* kinsol_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  StepReport report_;
  State before_;
  Filter filter_, held_;  // at the velocity at the start of the solve; the same with z = 0
  std::vector<ContactFriction> friction_;
  Search search_;
  double h_ = 0, scale_ = 0, mass_ = 0;  // s, N s, norm of all masses [kg]
  RoundOff noise_;                       // at the point where A was assembled last
  bool solved_ = false;                  // whether the last equation was solved to its tolerance
  VecX x_, x_bar_, damped_at_, v_, v_n_, v_here_, F_, f_scale_, one_, b_, dv_, minus_F_;
};

StepReport NewtonKinsol::advance(State& state, double h) {
  check_step(system_, state, h);
  system_.bind();
  report_ = {};
  double step_ms = 0;
  {
    const Stopwatch watch(step_ms);
    take_in_pieces(system_, constraints_, state, h, options_.max_halvings, before_, report_,
                   [&](const Piece& piece) { return attempt(state, piece); });
  }
  report_.step_ms = step_ms;
  return report_;
}

// KINSOL's solution within the contacts as they are, starting from the last solution.
class NewtonKinsol::ContactSolve {
 public:
  ContactSolve(NewtonKinsol& kinsol, const State& state) : kinsol_(kinsol), state_(state) {}

  bool solve() {
    kinsol_.x_bar_ = state_.x;
    if (kinsol_.contacts_->correction().size() > 0) kinsol_.x_bar_ += kinsol_.contacts_->correction();
    kinsol_.contacts_->filter(kinsol_.v_, kinsol_.filter_);
    for (const FilterEntry& e : kinsol_.filter_.entries()) kinsol_.v_.segment<3>(3 * e.particle) += e.z;
    kinsol_.friction_ = kinsol_.contacts_->friction();
    return kinsol_.solve();
  }
  ContactTrial trial() {  // the equation leaves the reaction in the locked directions
    kinsol_.equation(kinsol_.v_);
    const double noise = 2 * kinsol_.report_.residual * kinsol_.scale_;
    for (int i = 0; i < kinsol_.system_.particles(); ++i)
      kinsol_.contacts_->set_inertia(i, kinsol_.newton_.inertia(i));
    return {kinsol_.v_, kinsol_.x_, kinsol_.F_, noise, noise / kinsol_.mass_, kinsol_.scale_};
  }
  bool worth_settling() { return true; }
  void release() {}
  bool refine(double) { return false; }  // every solve is to the tolerance already
  void changed(const ContactChange& change) {
    if (change.met) {
      const Stopwatch watch(kinsol_.report_.collide_ms);
      kinsol_.system_.find_contacts({state_.time, kinsol_.h_, state_.x, state_.v, kinsol_.h_});
    }
  }
  void bodies_moved() {}

 private:
  NewtonKinsol& kinsol_;
  const State& state_;
};

bool NewtonKinsol::attempt(State& state, const Piece& piece) {
  const double h = piece.h;
  h_ = h;
  v_n_ = state.v;
  mass_ = 0;
  const VecX f = system_.force(state.x, state.v);
  for (double m : system_.masses()) mass_ += m * m;
  mass_ = std::sqrt(mass_);  // the impulse of gravity on it is known to act
  scale_ = h * std::max({mass_ * system_.gravity_acceleration().norm(), 1e-3 * std::sqrt(dot(f, f)), 1e-12});
  f_scale_.setConstant(1 / scale_);
  {
    const Stopwatch watch(report_.collide_ms);
    contacts_ = constraints_.begin_step(state.x, state.v, system_.masses(), state.time, h, Foresight::ahead,
                                        {.h = piece.of_step()});
    system_.begin_step({state.time, h, state.x, state.v, h});
  }
  v_ = state.v;
  for (int i = 0; i < system_.particles(); ++i) v_.segment<3>(3 * i) += h * system_.gravity_acceleration();
  ContactSolve solve(*this, state);
  double imbalance = 0;
  if (!settle_contacts(*contacts_, options_, solve, report_, imbalance)) return false;
  if (!contacts_->bodies_agree() && !piece.shortest)  // in the shortest piece the report says it instead
    return fail("the motion of a body that reacts and that of the cloth do not agree");
  x_ = x_bar_ + h * v_;
  if (!x_.allFinite()) return fail("the new positions are not finite numbers");
  report_.converged = report_.converged && solved_;
  note_contacts(imbalance, options_, report_);
  end_step(*contacts_, x_, v_, report_);
  system_.end_step(x_);
  state.x = x_;
  state.v = v_;
  state.time += h;
  return true;
}

bool NewtonKinsol::solve() {
  held_.clear();
  for (const FilterEntry& e : filter_.entries()) held_.constrain(e.particle, e.S, Vec3::Zero());
  const VecX start = v_;
  constexpr std::array<Search, 3> searches = {{{KIN_LINESEARCH, Stiffness::tangent},
                                               {KIN_NONE, Stiffness::tangent},
                                               {KIN_NONE, Stiffness::majorant}}};
  search_ = searches.front();
  assemble(start);
  const double wanted = std::max({options_.newton_tolerance, 1e-15, noise_.impulse / scale_});
  int flag = KIN_SUCCESS;
  double norm = 0;
  for (const Search& search : searches) {
    search_ = search;
    flag = iterate(wanted, norm);
    if (v_.allFinite() && norm <= wanted) break;
    ++report_.rescues;
    if (!v_.allFinite()) v_ = start;
  }
  report_.residual = norm;
  solved_ = norm <= wanted;
  if (v_.allFinite() && (flag >= 0 || solved_)) return true;  // flag >= 0 also where its steps became tiny
  return fail("KINSOL: " + sundials::taken(KINGetReturnFlagName(flag)) + "; a shorter time step may help");
}

// KINSOL stops when the largest component of F is small. Here |F| has to be small, so KINSOL may have to go
// on.
int NewtonKinsol::iterate(double wanted, double& norm) {
  const sundials::View u(v_, context_), one(one_, context_), scale(f_scale_, context_);
  KINSetScaledStepTol(kinsol_, 1e-14);
  KINSetNumMaxIters(kinsol_, std::max(options_.newton_iterations, 50));
  KINSetMaxNewtonStep(kinsol_, 1e6 * std::sqrt(static_cast<double>(v_.size())));
  int flag = KIN_SUCCESS;
  double largest = wanted;
  for (int k = 0; k < 4 && flag >= 0; ++k) {
    KINSetFuncNormTol(kinsol_, largest);
    flag = KINSol(kinsol_, u, search_.strategy, one, scale);
    long iterations = 0;
    KINGetNumNonlinSolvIters(kinsol_, &iterations);
    report_.newton_iterations += static_cast<int>(iterations);
    KINGetFuncNorm(kinsol_, &norm);
    // Where F is not a finite number at the start, that norm is of another solve.
    if (flag == KIN_FIRST_SYSFUNC_ERR || flag == KIN_SYSFUNC_FAIL)
      norm = std::numeric_limits<double>::infinity();
    if (norm <= wanted || flag == KIN_STEP_LT_STPTOL) break;
    largest *= 0.5 * wanted / norm;
  }
  return flag;
}

// Returns the fraction of the direction that lowers Phi enough.  [Nocedal & Wright 2006, section 3.1]
double NewtonKinsol::step_length(const VecX& v, const VecX& dv, double slope) {
  if (search_.strategy != KIN_NONE) return 1;  // KINSOL finds the length itself
  damped_at_ = x_bar_ + h_ * v;
  const double start = potential(v), allowed = start + noise_.energy(start);
  double length = 1;
  for (int halvings = 0; halvings < 20; ++halvings, length *= 0.5)
    if (potential(v + length * dv) <= allowed + 1e-4 * length * slope) return length;
  return length;
}

double NewtonKinsol::potential(const VecX& v) {
  x_ = x_bar_ + h_ * v;
  const double inertia = sum_chunks(system_.particles(), [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i)
      sum +=
          0.5 * system_.masses()[i] *
          (v.segment<3>(3 * i) - v_n_.segment<3>(3 * i) - h_ * system_.gravity_acceleration()).squaredNorm();
    return sum;
  });
  double rubbed = 0;
  for (const ContactFriction& f : friction_) {
    const Vec3 slip = v.segment<3>(3 * f.particle) - f.body_velocity;
    rubbed += 0.5 * h_ * slip.dot(f.damping * slip) - f.impulse.dot(slip);
  }
  return inertia + system_.stored_energy(x_) + h_ * dissipation_of_forces(system_, damped_at_, v) + rubbed;
}

// Sets F = M (v - v_n) - h f(x_bar + h v, v) + friction, without the filter.
void NewtonKinsol::equation(const VecX& v) {
  x_ = x_bar_ + h_ * v;
  F_.setZero();
  for (const auto& force : system_.forces()) force->add_force(x_, v, F_);
  for_chunks(system_.particles(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      F_.segment<3>(3 * i) = system_.masses()[i] * (v.segment<3>(3 * i) - v_n_.segment<3>(3 * i) -
                                                    h_ * system_.gravity_acceleration()) -
                             h_ * F_.segment<3>(3 * i);
  });
  for (const ContactFriction& f : friction_)
    F_.segment<3>(3 * f.particle) +=
        h_ * (f.damping * (v.segment<3>(3 * f.particle) - f.body_velocity)) - f.impulse;
}

int NewtonKinsol::residual(N_Vector v, N_Vector F) {
  const Stopwatch watch(report_.assemble_ms);
  dv_ = sundials::numbers(v);
  equation(dv_);
  held_.apply(F_);
  sundials::numbers(F) = F_;
  return F_.allFinite() ? 0 : 1;
}

// Assembles A at v.
int NewtonKinsol::set_up(N_Vector v) {
  v_here_ = sundials::numbers(v);
  assemble(v_here_);
  return 0;
}

void NewtonKinsol::assemble(const VecX& v) {
  const Stopwatch watch(report_.assemble_ms);
  x_ = x_bar_ + h_ * v;
  newton_.follow_system();
  newton_.assemble({x_, v, v, h_, search_.stiffness}, system_.masses(), b_);  // b is not used
  newton_.rub(
      friction_.size(), [&](std::size_t f) { return friction_[f].particle; },
      [&](std::size_t f) { return Mat3(h_ * friction_[f].damping); });
  noise_ = round_off(system_, newton_.matrix(), x_, v, h_);
}

int NewtonKinsol::solve_linear(N_Vector dv, N_Vector minus_F) {
  const Stopwatch watch(report_.solve_ms);
  minus_F_ = sundials::numbers(minus_F);
  dv_.setZero();
  // The solve need not be more accurate than the next residual can show.
  const double wanted = 0.1 * options_.newton_tolerance * scale_ / std::sqrt(dot(minus_F_, minus_F_));
  const double tolerance = std::max(options_.tolerance, std::min(wanted, 1e-2));
  const LinearReport linear =
      newton_.solve(minus_F_, held_, {tolerance, options_.max_linear_iterations, 0}, dv_);
  count_solve(linear, report_);
  if (linear.reason == StopReason::indefinite || linear.reason == StopReason::not_finite) return -1;
  dv_ *= step_length(v_here_, dv_, -dot(minus_F_, dv_));
  sundials::numbers(dv) = dv_;
  return 0;
}

bool NewtonKinsol::fail(const std::string& what) {
  report_.failure = {what, -1, std::string(system_.not_finite_force(x_, v_))};
  Eigen::Index worst = 0;
  F_.cwiseAbs().maxCoeff(&worst);
  report_.failure.particle = static_cast<int>(worst / 3);
  return false;
}

}  // namespace

std::unique_ptr<Integrator> make_newton_kinsol(System& system, Constraints& constraints,
                                               std::unique_ptr<LinearSolver> solver,
                                               const StepOptions& options) {
  return std::make_unique<NewtonKinsol>(system, constraints, std::move(solver), options);
}

}  // namespace drape::internal
