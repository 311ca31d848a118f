#include "solver/implicit_euler.h"

#include <cmath>

#include "mesh/obj.h"
#include "mesh/parallel.h"
#include "solver/stopwatch.h"

namespace drape {

ImplicitEuler::ImplicitEuler(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
                             const StepOptions& options)
    : system_(system), constraints_(constraints), solver_(std::move(solver)), options_(options) {}

StepReport ImplicitEuler::advance(State& state, double h) {
  if (!(h > 0) || !std::isfinite(h))
    throw InputError("time step = " + std::to_string(h) + " s: a time step is greater than zero");
  if (state.particles() != system_.particles() || state.v.size() != state.x.size())
    throw InputError("state: " + std::to_string(state.particles()) + " particles, but the system has " +
                     std::to_string(system_.particles()));
  StepReport report;
  {
    const Stopwatch watch(report.step_ms);
    const double start = state.time;
    int halvings = 0, pieces_left = 1;
    report.substeps = 0;
    while (pieces_left > 0) {
      if (attempt(state, std::ldexp(h, -halvings), report)) {
        --pieces_left;
        ++report.substeps;
      } else if (halvings == options_.max_halvings) {
        report.done = false;
        break;
      } else {
        ++halvings;
        pieces_left *= 2;
      }
    }
    if (report.done) {
      state.time = start + h;
      report.failure = {};
    }
  }
  return report;
}

void ImplicitEuler::resize() {
  const auto& pattern = system_.bind();
  if (A_ && &A_->pattern() == pattern.get()) return;
  A_ = std::make_unique<BlockMatrix>(pattern);
  const Eigen::Index n = 3 * system_.particles();
  for (VecX* vector : {&x_, &v_, &x_bar_, &y_, &x_new_, &v_new_, &v_base_, &guess_, &b_, &b_friction_,
                       &dv_rows_, &b_rows_, &dv_})
    vector->setZero(n);
  filter_.reserve(static_cast<std::size_t>(system_.particles()));
  rubbed_.reserve(static_cast<std::size_t>(system_.particles()));
}

bool ImplicitEuler::attempt(State& state, double h, StepReport& report) {
  resize();
  const double fall = h * system_.gravity_acceleration().norm();
  weight_impulse_ = fall_energy_ = 0;
  for (double m : system_.masses()) {
    weight_impulse_ += m * m;
    fall_energy_ += m * fall * fall;
  }
  weight_impulse_ = fall * std::sqrt(weight_impulse_);

  guess(h);
  {
    const Stopwatch watch(report.collide_ms);
    constraints_.begin_step(state.x, state.v, system_.masses(), h);
  }
  x_ = state.x;
  v_ = state.v;
  LinearReport linear;
  bool full = false;  // the last Newton step was taken whole
  for (int k = 0; k < options_.newton_iterations || !full; ++k) {
    if (k == options_.newton_iterations + options_.max_rescues)
      return fail(report, "no step lowers the energy", linear);
    // Linearise at (x, v): A = M + c D + c^2 K, b = M (v_bar - v) + c (f - K y).
    x_bar_ = state.x;
    if (constraints_.correction().size() > 0) x_bar_ += constraints_.correction();
    y_ = x_bar_ + h * v_ - x_;
    {
      const Stopwatch watch(report.assemble_ms);
      assemble(state.v, h, full || k == 0 ? Stiffness::chord : Stiffness::majorant);
    }
    if (k > 0) {
      if (full && nonlinear_residual(h) <= options_.newton_tolerance * weight_impulse_) break;
      guess_.setZero();
    }
    // Solve S (A dv - b) = 0 until the contacts agree with the solution.
    linear = solve_within_contacts(h, report);
    ++report.newton_iterations;
    if (!good(linear))
      return fail(report, "linear solve: " + std::string(drape::name(linear.reason)), linear);
    // v += dv, x = x_bar + c v
    full = descend(state.v, k == 0, h);
    if (!full) ++report.rescues;
    x_ = x_bar_ + h * v_;
    if (!x_.allFinite()) return fail(report, "the new positions are not finite numbers", linear);
  }
  x_new_ = x_;
  v_new_ = v_;
  {
    const Stopwatch watch(report.collide_ms);
    const ContactReport contact = constraints_.end_step(x_new_, v_new_);
    report.contacts = contact.contacts;
    report.guarded += contact.guarded;
    report.penetration = std::max(report.penetration, contact.deepest);
  }
  report.residual = std::max(report.residual, linear.residual);
  report.converged = report.converged && linear.reason == StopReason::converged;
  state.x = x_new_;
  state.v = v_new_;
  state.time += h;
  return true;
}

// What the velocity will change by, as a start for the iteration: free fall. So rigid motion is right from
// the first iterate, and a solve that is cut short cannot eat gravity.
void ImplicitEuler::guess(double h) {
  for (Eigen::Index i = 0; i < guess_.size() / 3; ++i)
    guess_.segment<3>(3 * i) = h * system_.gravity_acceleration();
}

void ImplicitEuler::assemble(const VecX& v_bar, double h, Stiffness stiffness) {
  A_->set_to_mass(system_.masses());
  const std::vector<double>& mass = system_.masses();
  for_chunks(system_.particles(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      b_.segment<3>(3 * i) =
          mass[static_cast<std::size_t>(i)] *
          (v_bar.segment<3>(3 * i) - v_.segment<3>(3 * i) + h * system_.gravity_acceleration());
  });
  for (const auto& force : system_.forces()) force->add_linearised(x_, v_, y_, h, stiffness, *A_, b_);
}

LinearReport ImplicitEuler::solve_within_contacts(double h, StepReport& report) {
  // Which contacts hold is found with loose solves; the last one is to the tolerance asked for, from where
  // they came.
  const bool contact = !constraints_.obstacles().empty();
  double tolerance =
      contact ? std::max(options_.tolerance, std::sqrt(options_.tolerance)) : options_.tolerance;
  for (int round = 0;; ++round) {
    if (round == options_.max_contact_solves) tolerance = options_.tolerance;
    LinearReport linear;
    {
      const Stopwatch watch(report.solve_ms);
      linear = solve_once(h, tolerance);
    }
    ++report.linear_solves;
    report.linear_iterations += linear.iterations;
    if (linear.reason == StopReason::indefinite || linear.reason == StopReason::not_finite) return linear;
    if (!contact || round == options_.max_contact_solves) return linear;

    const Stopwatch watch(report.collide_ms);
    v_new_ = v_ + dv_;
    // Twice the residual: what the solve left over is not a reaction.
    bool changed = constraints_.react(v_new_, r_, 2 * linear.residual_impulse);
    x_new_ = x_bar_ + h * v_new_;
    if (constraints_.check_paths(x_new_)) changed = true;
    if (!changed && (tolerance == options_.tolerance || linear.residual <= options_.tolerance)) return linear;
    if (!changed) tolerance = options_.tolerance;
    guess_ = dv_;
  }
}

LinearReport ImplicitEuler::solve_once(double h, double tolerance) {
  const BlockPattern& pattern = A_->pattern();
  b_friction_ = b_;
  add_contact_friction(h);
  to_rows(pattern, b_friction_, b_rows_);
  to_rows(pattern, guess_, dv_rows_);
  constraints_.filter(v_, filter_);
  filter_.renumber(pattern.row_of());
  const LinearOptions options{tolerance, options_.max_linear_iterations, weight_impulse_};
  const LinearReport linear = solver_->solve(*A_, b_rows_, filter_, options, dv_rows_);
  to_particles(pattern, dv_rows_, dv_);
  if (!constraints_.obstacles().empty()) reaction();  // while the friction stands in A
  remove_contact_friction();
  return linear;
}

// |S b| at (x, v): what is left of the nonlinear equation in the free directions.
double ImplicitEuler::nonlinear_residual(double h) {
  b_friction_ = b_;
  add_contact_friction(h);
  remove_contact_friction();
  constraints_.filter(v_, filter_);
  filter_.apply(b_friction_);
  return std::sqrt(dot(b_friction_, b_friction_));
}

// r = A dv - b: the impulse with which the constraints hold the particles.
void ImplicitEuler::reaction() {
  r_.resize(dv_.size());
  r_rows_.resize(dv_.size());
  A_->multiply(dv_rows_, r_rows_);
  r_rows_ -= b_rows_;
  to_particles(A_->pattern(), r_rows_, r_);
}

void ImplicitEuler::add_contact_friction(double h) {
  rubbed_.clear();
  for (const ContactFriction& f : constraints_.friction()) {
    const int slot = A_->pattern().diagonal(A_->pattern().row_of()[static_cast<std::size_t>(f.particle)]);
    const Vec3 slip = v_.segment<3>(3 * f.particle) - f.body_velocity;
    b_friction_.segment<3>(3 * f.particle) += f.impulse - h * (f.damping * slip);
    rubbed_.emplace_back(slot, A_->at(slot));
    A_->at(slot) += h * f.damping;
  }
}

void ImplicitEuler::remove_contact_friction() {
  for (const auto& [slot, block] : rubbed_) A_->at(slot) = block;
}

bool ImplicitEuler::good(const LinearReport& linear) const {
  if (!dv_.allFinite()) return false;
  return linear.reason == StopReason::converged ||
         (linear.reason == StopReason::iteration_limit && options_.max_linear_iterations > 0);
}

bool ImplicitEuler::fail(StepReport& report, const std::string& what, const LinearReport& linear) {
  report.residual = linear.residual;
  report.failure = {what, -1, std::string(system_.not_finite_force(x_, v_))};
  double worst = -1;
  for (int i = 0; i < system_.particles(); ++i) {
    const double size = dv_.segment<3>(3 * i).norm();
    if (std::isfinite(size) && size <= worst) continue;
    worst = size;
    report.failure.particle = i;
    if (!std::isfinite(size)) break;
  }
  if (report.failure.force.empty()) report.failure.force = stiffest_force(report.failure.particle);
  return false;
}

// The force with the largest stiffness at a particle, or one that is not finite: what to look at when a solve
// failed there.
std::string ImplicitEuler::stiffest_force(int particle) {
  const int slot = A_->pattern().diagonal(A_->pattern().row_of()[static_cast<std::size_t>(particle)]);
  std::string stiffest;
  double most = -1;
  for (const auto& force : system_.forces()) {
    A_->set_to_mass(std::vector<double>(system_.masses().size(), 0.0));
    force->add_linearised(x_, v_, y_, 1.0, Stiffness::majorant, *A_, b_);
    const double size = A_->at(slot).norm();
    if (size <= most) continue;
    stiffest = force->name();
    if (!std::isfinite(size)) break;
    most = size;
  }
  return stiffest;
}

// Phi(v), see the header.
double ImplicitEuler::potential(const VecX& v, const VecX& v_bar, double h) {
  x_new_ = x_bar_ + h * v;
  const std::vector<double>& mass = system_.masses();
  double phi = sum_chunks(system_.particles(), [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      const Vec3 d = v.segment<3>(3 * i) - v_bar.segment<3>(3 * i) - h * system_.gravity_acceleration();
      sum += 0.5 * mass[static_cast<std::size_t>(i)] * d.squaredNorm();
    }
    return sum;
  });
  for (const auto& force : system_.forces()) phi += force->energy(x_new_) + h * force->dissipation(x_, v);
  for (const ContactFriction& f : constraints_.friction()) {
    const Vec3 slip = v.segment<3>(3 * f.particle) - f.body_velocity;
    phi += 0.5 * h * slip.dot(f.damping * slip) - f.impulse.dot(slip);
  }
  return phi;
}

// v <- v + dv when that lowers Phi, else as far towards it as does. True when the step was taken whole.
bool ImplicitEuler::descend(const VecX& v_bar, bool first, double h) {
  v_base_ = v_;
  if (first) {  // the point of linearisation: standing still, but for what is prescribed
    constraints_.filter(v_, filter_);
    v_base_ = -v_;
    filter_.impose(v_base_);
    v_base_ += v_;
  }
  v_ += dv_;
  const double start = potential(v_base_, v_bar, h);
  // A tenth of the energy that the fall of one step brings: what a solve to its tolerance may leave.
  const double allowed = start + 1e-9 * std::abs(start) + 0.05 * fall_energy_;
  for (int halvings = 0; halvings < 12; ++halvings) {
    if (potential(v_, v_bar, h) <= allowed) return halvings == 0;
    v_ = 0.5 * (v_ + v_base_);
  }
  return false;
}

std::unique_ptr<Integrator> make_integrator(std::string_view name, System& system, Constraints& constraints,
                                            std::unique_ptr<LinearSolver> solver,
                                            const StepOptions& options) {
  if (name == "implicit-euler")
    return std::make_unique<ImplicitEuler>(system, constraints, std::move(solver), options);
  throw InputError("integrator '" + std::string(name) + "' is not in this build; it has: implicit-euler");
}

std::vector<IntegratorInfo> integrators() {
  return {{"implicit-euler", "Baraff & Witkin's implicit step, 1 to n Newton iterations (default)"}};
}

}  // namespace drape
