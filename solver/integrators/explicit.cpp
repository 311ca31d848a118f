#include "solver/integrators/explicit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/base/stopwatch.h"

namespace drape {

const std::vector<Tableau>& tableaux() {
  static const std::vector<Tableau> all = {
      {"explicit-euler", "order 1, unstable without damping", 1, {}, {1}},
      {"symplectic-euler", "order 1, keeps energy below its limit h < 2/omega", 1, {}, {1}, true},
      {"midpoint", "explicit, order 2, two forces a step", 2, {{{}, {0.5}}}, {0, 1}},
      {"sb-implicit",
       "what SB call implicit Euler: one more look, explicit, order 1, h < 1/omega",
       2,
       {{{}, {1}}},
       {0, 1}},
      {"rk4",
       "the classical one: order 4, h < 2.83/omega",
       4,
       {{{}, {0.5}, {0, 0.5}, {0, 0, 1}}},
       {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}},
  };
  return all;
}

Explicit::Explicit(const Tableau& tableau, System& system, Constraints& constraints,
                   const StepOptions& options, ContactMode contact)
    : tableau_(tableau),
      system_(system),
      motion_(system, constraints, contact, explicit_kappa),
      options_(options) {}

StepReport Explicit::advance(State& state, double h) {
  check_step(system_, state, h);
  system_.bind();
  StepReport report;
  {
    const Stopwatch watch(report.step_ms);
    take(state, h, report);
  }
  return report;
}

void Explicit::take(State& state, double h, StepReport& report) {
  motion_.begin(state, h, report);
  count_given(state);
  const VecX& start = motion_.start_velocity();
  double work = 0;  // J, done by what holds particles
  for (std::size_t i = 0; i < static_cast<std::size_t>(tableau_.stages); ++i) {
    x_ = state.x;
    V_[i] = start;
    for (std::size_t j = 0; j < i; ++j) {
      if (tableau_.a[i][j] == 0) continue;
      x_ += (h * tableau_.a[i][j]) * V_[j];
      V_[i] += (h * tableau_.a[i][j]) * A_[j];
    }
    const Stopwatch assembly(report.assemble_ms);
    motion_.acceleration(x_, V_[i], A_[i]);
    work += h * tableau_.b[i] * motion_.power();
    motion_.count(h * tableau_.b[i], x_, V_[i]);
  }
  x_ = state.x;
  v_ = start;
  for (std::size_t i = 0; i < static_cast<std::size_t>(tableau_.stages); ++i) {
    if (tableau_.b[i] == 0) continue;
    if (!tableau_.positions_last) x_ += (h * tableau_.b[i]) * V_[i];
    v_ += (h * tableau_.b[i]) * A_[i];
  }
  if (tableau_.positions_last) x_ += h * v_;
  given_ += std::max(0.0, work) + std::max(0.0, system_.gravity_energy(state.x) - system_.gravity_energy(x_));
  given_ += h * std::max(system_.given_power(state.x, start), system_.given_power(x_, v_));
  if (explodes(h)) {
    report.done = false;
    report.failure = explosion();
  } else {
    motion_.finish(x_, v_, h, options_, state, report);
  }
  if (!report.done) {
    report.failure.what += "; an explicit method needs a shorter time step, or take an implicit one";
    x_.resize(0);
  }
}

// Adds the energy that came since the end of the last step, by contact or from outside; before the first
// step, all the energy that there is.
void Explicit::count_given(const State& state) {
  double more = system_.kinetic_energy(motion_.start_velocity());
  if (x_.size() != state.x.size())
    more += system_.stored_energy(state.x);
  else if (x_ == state.x)
    more -= system_.kinetic_energy(v_);
  else
    more += system_.stored_energy(state.x) - system_.kinetic_energy(v_) - system_.stored_energy(x_);
  given_ += std::max(0.0, more);
}

// The header explains the test. The fall of one whole step counts as given, because a scheme may give the
// speed before the fall. A speed below a micrometre per second counts as standing still, so that round-off is
// not a motion.
bool Explicit::explodes(double h) const {
  constexpr double too_much = 1000, still = 1e-6;  // m/s
  const double mass = std::accumulate(system_.masses().begin(), system_.masses().end(), 0.0);
  const double fall = h * system_.gravity_acceleration().norm();
  const double kinetic = system_.kinetic_energy(v_);
  return std::isfinite(kinetic) && kinetic > too_much * (given_ + mass * (fall * fall + still * still));
}

// Names the fastest particle and the force that holds most of the energy.
StepFailure Explicit::explosion() const {
  StepFailure failure{.what = "the cloth has a thousand times the energy that it was ever given",
                      .force = {}};
  double fastest = -1, most = -1;
  for (int i = 0; i < system_.particles(); ++i)
    if (const double speed = v_.segment<3>(3 * i).squaredNorm(); speed > fastest)
      fastest = speed, failure.particle = i;
  for (const auto& force : system_.forces())
    if (const double energy = force->energy(x_); energy > most) most = energy, failure.force = force->name();
  return failure;
}

}  // namespace drape
