#include "solver/integrators/pbd.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/held_motion.h"

namespace drape::internal {
namespace {

void check(const ProjectionOptions& options) {
  if (options.substeps < 1 || options.iterations < 1)
    throw InputError("pbd: substeps = " + std::to_string(options.substeps) + ", iterations = " +
                     std::to_string(options.iterations) + ": expected at least 1 of each");
  if (!(options.alpha >= 0) || !(options.alpha <= 1))
    throw InputError("pbd: alpha = " + std::to_string(options.alpha) +
                     ": expected the share of the way that a link is drawn to its length, from 0 to 1");
}

std::vector<const Clusters*> clusters_of(const System& system) {
  std::vector<const Clusters*> all;
  for (const auto& force : system.forces())
    if (const Clusters* const clusters = force->clusters()) all.push_back(clusters);
  return all;
}

}  // namespace

Pbd::Pbd(System& system, Constraints& constraints, const StepOptions& options, ContactMode contact)
    : system_(system),
      constraints_(constraints),
      options_(options),
      contact_(contact),
      clusters_(clusters_of(system)) {
  check(options.projection);
  for (const auto& force : system.forces())
    if (!force->projects())
      throw InputError("integrator \"pbd\": the force '" + std::string(force->name()) +
                       "' has no position-based form; leave it out, or take \"implicit-euler\"");
}

StepReport Pbd::advance(State& state, double h) {
  check_step(system_, state, h);
  system_.bind();
  StepReport report;
  before_ = state;
  system_.keep();
  constraints_.keep();
  const int substeps = options_.projection.substeps;
  {
    const Stopwatch watch(report.step_ms);
    for (int k = 0; k < substeps && report.done; ++k) {
      take(state, h / substeps, k + 1 == substeps, report);
      state.time = before_.time + h * (k + 1) / substeps;
    }
  }
  if (report.done) {
    state.time = before_.time + h;
    report.inner_steps = substeps;
    report.converged = report.converged && report.residual <= options_.tolerance;
  } else {
    state = before_;
    system_.go_back();
    constraints_.go_back();
    clusters_.forget();
  }
  return report;
}

void Pbd::take(State& state, double h, bool last, StepReport& report) {
  {
    const Stopwatch watch(report.collide_ms);
    contacts_ = constraints_.begin_step(state.x, state.v, system_.masses(), state.time, h, Foresight::none);
    contacts_->let_take(clusters_);
  }
  {
    const Stopwatch watch(report.assemble_ms);
    system_.begin_step({state.time, h, state.x, state.v, h});
    for (const auto& force : system_.forces()) force->begin_substep(system_.particles());
    hold(state, h);
    predict(state, h);
  }
  for (int k = 0; k < options_.projection.iterations; ++k) project(state, h, k, report);
  if (contacts_->bodies())
    contacts_->settle_faces(x_, v_);
  else if (!responds())
    v_ = (x_ - state.x) / h;
  if (!x_.allFinite() || !v_.allFinite()) {
    report.done = false;
    report.failure = not_finite(system_, x_, v_, "the new positions are not finite numbers");
    return;
  }
  if (!contacts_->bodies_agree(0.5)) {  // a smaller difference counts as not converged
    report.done = false;
    report.failure = {.what = "the motion of a body that reacts and that of the cloth do not agree",
                      .force = {}};
    return;
  }
  if (last) report.residual = residual(state, h);
  note_contacts(clusters_.unsettled(), options_, report);
  end_step(*contacts_, x_, v_, report);
  system_.end_step(x_);
  state.x = x_;
  state.v = v_;
}

// How each particle may move: by its mass, not at all, or with the body that carries it.
void Pbd::hold(const State& state, double h) {
  const std::vector<double>& masses = system_.masses();
  mobility_.resize(masses.size());
  for (std::size_t i = 0; i < masses.size(); ++i) mobility_[i] = masses[i] > 0 ? 1 / masses[i] : 0;
  contacts_->filter(state.v, held_);
  for (const FilterEntry& e : held_.entries()) mobility_[static_cast<std::size_t>(e.particle)] = 0;
  pulled_.setZero(state.x.size());
  for (const MovingPin& pin : contacts_->moving_pins()) {
    const auto particle = static_cast<std::size_t>(pin.particle);
    mobility_[particle] = contacts_->mobility_of(pin);
    pulled_.segment<3>(3 * pin.particle) = -h * masses[particle] * system_.gravity_acceleration();
  }
}

// Where the particles would go by gravity alone, or by what holds them.
void Pbd::predict(const State& state, double h) {
  predicted_.resize(state.x.size());
  const Vec3 fall = h * system_.gravity_acceleration();
  for_chunks(system_.particles(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      predicted_.segment<3>(3 * i) = state.x.segment<3>(3 * i) + h * (state.v.segment<3>(3 * i) + fall);
  });
  for (const FilterEntry& e : held_.entries())
    predicted_.segment<3>(3 * e.particle) =
        state.x.segment<3>(3 * e.particle) + h * (state.v.segment<3>(3 * e.particle) + e.z);
  x_ = predicted_;
  moved_.setZero(x_.size());
}

// One iteration: every element in turn, and then the bodies.
void Pbd::project(const State& state, double h, int iteration, StepReport& report) {
  const ProjectionOptions& options = options_.projection;
  {
    const Stopwatch watch(report.solve_ms);
    carried_.clear();
    for (const MovingPin& pin : contacts_->moving_pins()) carried_.push_back(x_.segment<3>(3 * pin.particle));
    Substep substep{h, state.x, mobility_, x_, options, iteration == 0, iteration + 1 == options.iterations};
    for (const auto& force : system_.forces()) force->project(substep);
    pull_bodies(h);
  }
  const Stopwatch watch(report.collide_ms);
  if (responds()) meet_bodies(state, h);
}

// Whether anything answers the motion of the particles besides the elements.
bool Pbd::responds() const { return contacts_->bodies() || clusters_.takes_pairs(); }

// The elements have moved the pins by what the bodies there give way to: the impulse goes to the body, and
// the pin back to it.
void Pbd::pull_bodies(double h) {
  auto place = carried_.begin();
  for (const MovingPin& pin : contacts_->moving_pins()) {
    const double mobility = mobility_[static_cast<std::size_t>(pin.particle)];
    auto x = x_.segment<3>(3 * pin.particle);
    if (mobility > 0) pulled_.segment<3>(3 * pin.particle) -= (x - *place) / (h * mobility);
    x = *place++;
  }
}

// The response of the bodies to the motion as it would be without them.
void Pbd::meet_bodies(const State& state, double h) {
  constexpr double round_off = 1e-9;
  const std::vector<double>& masses = system_.masses();
  const double heaviest = *std::max_element(masses.begin(), masses.end());
  free_ = x_ - moved_;
  free_v_ = (free_ - state.x) / h;
  contacts_->respond(contact_, free_, free_v_, pulled_, clusters_.any() ? &clusters_ : nullptr, x_, v_,
                     round_off * heaviest * h * system_.gravity_acceleration().norm());
  moved_ = x_ - free_;
  for (const MovingPin& pin : contacts_->moving_pins()) moved_.segment<3>(3 * pin.particle).setZero();
}

// Whether the particle is a pin that moves: its equation is that of what carries it.
bool Pbd::is_carried(int particle) const {
  const std::vector<MovingPin>& pins = contacts_->moving_pins();
  return std::any_of(pins.begin(), pins.end(),
                     [particle](const MovingPin& pin) { return pin.particle == particle; });
}

// What the elements and the bodies leave of the equation of the substep, relative to the weight, or where
// nothing weighs, to the forces.
double Pbd::residual(const State& state, double h) {
  free_v_ = (x_ - state.x) / h;
  push_.setZero(x_.size());
  for (const auto& force : system_.forces()) force->add_force(x_, free_v_, push_);
  double left = 0, forces = 0, weight = 0, places = 0;
  for (int i = 0; i < system_.particles(); ++i) {
    const double mobility = mobility_[static_cast<std::size_t>(i)];
    if (mobility == 0 || is_carried(i)) continue;
    const Vec3 f = push_.segment<3>(3 * i);
    const Vec3 moved = x_.segment<3>(3 * i) - predicted_.segment<3>(3 * i) - moved_.segment<3>(3 * i);
    left += (moved / (h * mobility) - h * f).squaredNorm();
    forces += (h * f).squaredNorm();
    weight += (h / mobility * system_.gravity_acceleration()).squaredNorm();
    places += (x_.segment<3>(3 * i) / (h * mobility)).squaredNorm();
  }
  constexpr double round_off = 1e-13;  // of a difference of places
  const double reference = weight > 0 ? weight : forces;
  return reference > 0 && left > round_off * round_off * places ? std::sqrt(left / reference) : 0;
}

}  // namespace drape::internal
