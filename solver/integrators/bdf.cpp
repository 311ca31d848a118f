#include "solver/integrators/bdf.h"

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/pieces.h"
#include "solver/integrators/potential.h"

namespace drape {

Bdf::Bdf(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
         const StepOptions& options, int order)
    : system_(system),
      constraints_(constraints),
      solver_(std::move(solver)),
      options_(options),
      order_(order) {
  if (order != 1 && order != 2) throw InputError("bdf order = " + std::to_string(order) + ": it is 1 or 2");
}

StepReport Bdf::advance(State& state, double h) {
  check_step(system_, state, h);
  StepReport report;
  {
    const Stopwatch watch(report.step_ms);
    take_in_pieces(state, h, options_.max_halvings, before_, report,
                   [&](const Piece& piece) { return attempt(state, piece, report); });
  }
  return report;
}

void Bdf::resize() {
  const auto& pattern = system_.bind();
  if (A_ && &A_->pattern() == pattern.get()) return;
  A_ = std::make_unique<BlockMatrix>(pattern);
  const Eigen::Index n = 3 * system_.particles();
  for (VecX* vector : {&x_, &v_, &x_bar_, &v_bar_, &y_, &x_new_, &v_new_, &v_base_, &guess_, &b_,
                       &b_friction_, &dv_rows_, &b_rows_, &dv_})
    vector->setZero(n);
  past_.touched.assign(static_cast<std::size_t>(system_.particles()), 0);
  past_.h = 0;
  filter_.reserve(static_cast<std::size_t>(system_.particles()));
  rubbed_.reserve(static_cast<std::size_t>(system_.particles()));
  friction_.reserve(static_cast<std::size_t>(system_.particles()));
}

bool Bdf::attempt(State& state, const Piece& piece, StepReport& report) {
  resize();
  const double h = piece.h;
  const double fall = h * system_.gravity_acceleration().norm();
  weight_impulse_ = fall_energy_ = 0;
  for (double m : system_.masses()) {
    weight_impulse_ += m * m;
    fall_energy_ += m * fall * fall;
  }
  weight_impulse_ = fall * std::sqrt(weight_impulse_);

  choose_coefficients(state, h, piece.whole);
  {
    const Stopwatch watch(report.collide_ms);
    constraints_.begin_step(state.x, state.v, system_.masses(), state.time, h);
  }
  x_ = state.x;
  v_ = state.v;
  if (back_ > 0) look_back(state);
  guess();
  LinearReport linear;
  bool full = false;  // the last Newton step was taken whole
  for (int k = 0; k < options_.newton_iterations || !full; ++k) {
    if (k == options_.newton_iterations + options_.max_rescues)
      return fail(report, "no step lowers the energy", linear);
    // Linearise at (x, v): A = M + c D + c^2 K, b = M (v_bar - v) + c (f - K y).
    const Stiffness stiffness = full || k == 0 ? Stiffness::chord : Stiffness::majorant;
    linearise(state, stiffness, report);
    if (k > 0) {
      if (full && nonlinear_residual() <= options_.newton_tolerance * weight_impulse_ + noise_.impulse) break;
      guess_.setZero();
    }
    // Solve S (A dv - b) = 0 until the contacts agree with the solution.
    linear = solve_within_contacts(state, stiffness, report);
    ++report.newton_iterations;
    if (!good(linear))
      return fail(report, "linear solve: " + std::string(drape::name(linear.reason)), linear);
    // v += dv, x = x_bar + c v
    full = descend(k == 0);
    if (!full) ++report.rescues;
    x_ = x_bar_ + c_ * v_;
    if (!x_.allFinite()) return fail(report, "the new positions are not finite numbers", linear);
  }
  if (back_ > 0 && makes_energy(state)) {
    ++report.rescues;
    return attempt(state, {h, false, piece.shortest}, report);
  }
  // In a shorter step the cloth weighs less on them; where none is short enough the report says so.
  if (!constraints_.bodies_converged() && !piece.shortest)
    return fail(report, "the motion of a body that reacts and that of the cloth do not agree", linear);
  x_new_ = x_;
  v_new_ = v_;
  end_step(constraints_, x_new_, v_new_, report);
  report.residual = std::max(report.residual, linear.residual);
  report.converged = report.converged && linear.reason == StopReason::converged;
  if (order_ == 2) remember(state, h);
  state.x = x_new_;
  state.v = v_new_;
  state.time += h;
  return true;
}

// More than what moving bodies bring and the error of a smooth motion: order 2 has looked back across a
// contact or a slackening of stiff cloth, and the step is taken again by order 1.
bool Bdf::makes_energy(const State& state) const {
  const double kinetic = system_.kinetic_energy(state.v), elastic = system_.elastic_energy(x_);
  const double before = kinetic + system_.elastic_energy(state.x) + system_.gravity_energy(state.x);
  const double after = system_.kinetic_energy(v_) + elastic + system_.gravity_energy(x_);
  return after > before + constraints_.work() + 0.05 * fall_energy_ + 1e-3 * kinetic + noise_.energy(elastic);
}

void Bdf::choose_coefficients(const State& state, double h, bool whole) {
  h_ = h;
  // BDF2 is stable as long as steps grow by less than 1 + sqrt(2).   [Hairer, Norsett & Wanner, III.5]
  const bool smooth = whole && past_.h > 0 && h <= 2 * past_.h && state.x.size() == past_.x_end.size() &&
                      state.x == past_.x_end && state.v == past_.v_end;
  ahead_ = order_ == 2 && smooth ? h / past_.h : 0;
  back_ = ahead_ * ahead_ / (1 + 2 * ahead_);
  c_ = (1 + ahead_) / (1 + 2 * ahead_) * h;
}

// The point of linearisation of order 2.
void Bdf::look_back(const State& state) {
  mark_touching();
  v_ = state.v + ahead_ * (state.v - past_.v);
  for (int i = 0; i < system_.particles(); ++i)
    if (restarts(i)) v_.segment<3>(3 * i) = state.v.segment<3>(3 * i);
  x_ = state.x + back_ * (state.x - past_.x) + c_ * v_;
}

// What the velocity will change by, as a start for the iteration: free fall. So rigid motion is right from
// the first iterate, and a solve that is cut short cannot eat gravity. (Order 2: it is in the extrapolation.)
void Bdf::guess() {
  for (Eigen::Index i = 0; i < guess_.size() / 3; ++i)
    guess_.segment<3>(3 * i) = back_ > 0 && !restarts(static_cast<int>(i))
                                   ? Vec3::Zero()
                                   : Vec3(h_ * system_.gravity_acceleration());
}

void Bdf::linearise(const State& state, Stiffness stiffness, StepReport& report) {
  x_bar_ = state.x;
  v_bar_ = state.v;
  mass_ = system_.masses();
  if (back_ > 0) {
    x_bar_ += back_ * (state.x - past_.x);
    v_bar_ += back_ * (state.v - past_.v);
    restart_touching(state);
  }
  if (constraints_.correction().size() > 0) x_bar_ += constraints_.correction();
  y_ = x_bar_ + c_ * v_ - x_;
  const Stopwatch watch(report.assemble_ms);
  assemble(stiffness);
  noise_ = round_off(*A_, x_, v_, c_);
}

// Particles whose past says nothing of their future, because a body stopped them or may: see the header.
void Bdf::restart_touching(const State& state) {
  for (int i = 0; i < system_.particles(); ++i) {
    if (!restarts(i)) continue;
    mass_[static_cast<std::size_t>(i)] *= c_ / h_;
    v_bar_.segment<3>(3 * i) = state.v.segment<3>(3 * i);
    x_bar_.segment<3>(3 * i) = state.x.segment<3>(3 * i) + (h_ - c_) * state.v.segment<3>(3 * i);
  }
  constraints_.filter(state.v, filter_);
  for (const FilterEntry& e : filter_.entries())
    if (restarts(e.particle)) x_bar_.segment<3>(3 * e.particle) += (h_ - c_) * e.z;
}

void Bdf::remember(const State& state, double h) {
  past_.x = state.x;
  past_.v = state.v;
  past_.x_end = x_new_;
  past_.v_end = v_new_;
  past_.h = h;
  std::fill(past_.touched.begin(), past_.touched.end(), 0);
  mark_touching();
}

void Bdf::mark_touching() {
  for (const Contact& c : constraints_.touching()) past_.touched[static_cast<std::size_t>(c.particle)] = 1;
  for (const MovingPin& p : constraints_.moving_pins())
    past_.touched[static_cast<std::size_t>(p.particle)] = 1;
  for (const FaceContact& c : constraints_.faces().touching())
    if (c.active)
      for (int i : c.particles) past_.touched[static_cast<std::size_t>(i)] = 1;
}

void Bdf::assemble(Stiffness stiffness) {
  A_->set_to_mass(mass_);
  for_chunks(system_.particles(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      b_.segment<3>(3 * i) =
          mass_[static_cast<std::size_t>(i)] *
          (v_bar_.segment<3>(3 * i) - v_.segment<3>(3 * i) + fall_time(i) * system_.gravity_acceleration());
  });
  for (const auto& force : system_.forces()) force->add_linearised(x_, v_, y_, c_, stiffness, *A_, b_);
}

LinearReport Bdf::solve_within_contacts(const State& state, Stiffness stiffness, StepReport& report) {
  // Which contacts hold is found with loose solves; the last one is to the tolerance asked for, from where
  // they came. Bodies that react wait for that one, and then the contacts may change their mind again.
  const bool contact = !constraints_.bodies().empty();
  double tolerance =
      contact ? std::max(options_.tolerance, std::sqrt(options_.tolerance)) : options_.tolerance;
  for (int round = 0;; ++round) {
    LinearReport linear;
    {
      const Stopwatch watch(report.solve_ms);
      linear = solve_once(tolerance);
    }
    ++report.linear_solves;
    report.linear_iterations += linear.iterations;
    if (linear.reason == StopReason::indefinite || linear.reason == StopReason::not_finite) return linear;
    if (!contact) return linear;

    const Stopwatch watch(report.collide_ms);
    const double noise = 2 * linear.residual_impulse;  // what the solve left over is not a reaction
    bool changed = false, anew = false;                // anew: the forces are others, too
    if (round < options_.max_contact_solves) {
      changed = constraints_.react(v_new_, r_, noise);
      x_new_ = x_bar_ + c_ * v_new_;
      const bool caught = constraints_.check_paths(x_new_), faces = constraints_.react_faces(x_new_, v_new_);
      if ((caught || faces) && back_ > 0) mark_touching();  // what is caught now starts anew
      changed = changed || caught || faces;
      anew = (caught && back_ > 0) || faces;
    }
    if (!changed) {
      if (linear.residual > options_.tolerance && tolerance > options_.tolerance) {
        tolerance = options_.tolerance;
      } else {
        if (!constraints_.move_bodies(noise)) return linear;
        round = 0;
        anew = back_ > 0 || !constraints_.faces().touching().empty();  // what they touch moves otherwise, too
      }
    }
    if (anew) linearise(state, stiffness, report);
    guess_ = dv_;
  }
}

LinearReport Bdf::solve_once(double tolerance) {
  const BlockPattern& pattern = A_->pattern();
  b_friction_ = b_;
  add_contact_friction();
  to_rows(pattern, b_friction_, b_rows_);
  to_rows(pattern, guess_, dv_rows_);
  constraints_.filter(v_, filter_);
  filter_.renumber(pattern.row_of());
  const LinearOptions options{tolerance, options_.max_linear_iterations, weight_impulse_};
  const LinearReport linear = solver_->solve(*A_, b_rows_, filter_, options, dv_rows_);
  to_particles(pattern, dv_rows_, dv_);
  if (!constraints_.bodies().empty() || !constraints_.moving_pins().empty())
    reaction();  // while the friction stands in A
  remove_contact_friction();
  return linear;
}

// |S b| at (x, v): what is left of the nonlinear equation in the free directions.
double Bdf::nonlinear_residual() {
  b_friction_ = b_;
  add_contact_friction();
  remove_contact_friction();
  constraints_.filter(v_, filter_);
  filter_.apply(b_friction_);
  return std::sqrt(dot(b_friction_, b_friction_));
}

// r = A dv - b: the impulse with which the constraints hold the particles.
void Bdf::reaction() {
  r_.resize(dv_.size());
  r_rows_.resize(dv_.size());
  A_->multiply(dv_rows_, r_rows_);
  r_rows_ -= b_rows_;
  to_particles(A_->pattern(), r_rows_, r_);
  const auto unscale = [&](int particle) { r_.segment<3>(3 * particle) /= row_scale(particle); };
  for (const Contact& c : constraints_.touching()) unscale(c.particle);
  for (const MovingPin& p : constraints_.moving_pins()) unscale(p.particle);
  v_new_ = v_ + dv_;
  constraints_.receive(v_new_, r_);
}

const std::vector<ContactFriction>& Bdf::friction() {
  friction_ = constraints_.friction();
  for (ContactFriction& f : friction_) {
    f.damping *= row_scale(f.particle);
    f.impulse *= row_scale(f.particle);
  }
  return friction_;
}

void Bdf::add_contact_friction() {
  rubbed_.clear();
  for (const ContactFriction& f : friction()) {
    const int slot = A_->pattern().diagonal(A_->pattern().row_of()[static_cast<std::size_t>(f.particle)]);
    const Vec3 slip = v_.segment<3>(3 * f.particle) - f.body_velocity;
    b_friction_.segment<3>(3 * f.particle) += f.impulse - h_ * (f.damping * slip);
    rubbed_.emplace_back(slot, A_->at(slot));
    A_->at(slot) += h_ * f.damping;
  }
}

void Bdf::remove_contact_friction() {
  for (const auto& [slot, block] : rubbed_) A_->at(slot) = block;
}

bool Bdf::good(const LinearReport& linear) const {
  if (!dv_.allFinite()) return false;
  return linear.reason == StopReason::converged ||
         (linear.reason == StopReason::iteration_limit && options_.max_linear_iterations > 0);
}

bool Bdf::fail(StepReport& report, const std::string& what, const LinearReport& linear) {
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
std::string Bdf::stiffest_force(int particle) {
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
double Bdf::potential(const VecX& v) {
  x_new_ = x_bar_ + c_ * v;
  const double inertia = sum_chunks(system_.particles(), [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      const Vec3 d =
          v.segment<3>(3 * i) - v_bar_.segment<3>(3 * i) - fall_time(i) * system_.gravity_acceleration();
      sum += 0.5 * mass_[static_cast<std::size_t>(i)] * d.squaredNorm();
    }
    return sum;
  });
  return inertia + potential_of_forces(system_, friction(), x_new_, v, c_, h_);
}

// v <- v + dv when that lowers Phi, else as far towards it as does. True when the step was taken whole.
bool Bdf::descend(bool first) {
  v_base_ = v_;
  if (first) {  // the point of linearisation: standing still, but for what is prescribed
    constraints_.filter(v_, filter_);
    v_base_ = -v_;
    filter_.impose(v_base_);
    v_base_ += v_;
  }
  v_ += dv_;
  const double start = potential(v_base_);
  // A tenth of the energy that the fall of one step brings: what a solve to its tolerance may leave.
  const double allowed = start + 1e-9 * std::abs(start) + 0.05 * fall_energy_ + noise_.energy(start);
  for (int halvings = 0; halvings < 12; ++halvings) {
    if (potential(v_) <= allowed) return halvings == 0;
    v_ = 0.5 * (v_ + v_base_);
  }
  return false;
}

}  // namespace drape
