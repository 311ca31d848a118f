#include "solver/explicit.h"

#include <cmath>
#include <numeric>

#include "solver/stopwatch.h"

namespace drape {

const std::vector<Tableau>& tableaux() {
  static const std::vector<Tableau> all = {
      {"explicit-euler", "order 1, unstable without damping", 1, {}, {1}},
      {"symplectic-euler", "order 1, keeps energy below its limit h < 2/omega", 1, {}, {1}, true},
      {"midpoint", "explicit, order 2, two forces a step", 2, {{{}, {0.5}}}, {0, 1}},
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
    : tableau_(tableau), system_(system), motion_(system, constraints, contact), options_(options) {}

StepReport Explicit::advance(State& state, double h) {
  check_step(system_, state, h);
  system_.bind();
  StepReport report;
  const Stopwatch watch(report.step_ms);
  motion_.begin(state, h, report);
  const VecX& start = motion_.start_velocity();
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
  }
  x_ = state.x;
  v_ = start;
  for (std::size_t i = 0; i < static_cast<std::size_t>(tableau_.stages); ++i) {
    if (tableau_.b[i] == 0) continue;
    if (!tableau_.positions_last) x_ += (h * tableau_.b[i]) * V_[i];
    v_ += (h * tableau_.b[i]) * A_[i];
  }
  if (tableau_.positions_last) x_ += h * v_;
  if (explodes(state, h)) {
    report.done = false;
    report.failure = explosion();
  } else {
    motion_.finish(x_, v_, h, options_, state, report);
  }
  if (!report.done)
    report.failure.what += "; an explicit method needs a shorter time step, or take an implicit one";
  return report;
}

// Beyond its limit a method multiplies the energy step by step. Long before the numbers end, what it gives is
// no cloth any more. A force that sets in does it once, but no motion does it three times running.
bool Explicit::explodes(const State& state, double h) {
  const double mass = std::accumulate(system_.masses().begin(), system_.masses().end(), 0.0);
  const double before =
      system_.kinetic_energy(state.v) + mass * (h * system_.gravity_acceleration()).squaredNorm();
  const double after = system_.kinetic_energy(v_);
  const bool grown = std::isfinite(after) && after > 4 * before &&
                     after + system_.elastic_energy(x_) > 4 * (before + system_.elastic_energy(state.x));
  growths_ = grown ? growths_ + 1 : 0;
  return growths_ >= 3;
}

// Which particle is the fastest, and which force holds most of the energy.
StepFailure Explicit::explosion() const {
  StepFailure failure{.what = "the energy grew fourfold in a step, three times running", .force = {}};
  double fastest = -1, most = -1;
  for (int i = 0; i < system_.particles(); ++i)
    if (const double speed = v_.segment<3>(3 * i).squaredNorm(); speed > fastest)
      fastest = speed, failure.particle = i;
  for (const auto& force : system_.forces())
    if (const double energy = force->energy(x_); energy > most) most = energy, failure.force = force->name();
  return failure;
}

}  // namespace drape
