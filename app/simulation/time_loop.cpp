#include "app/simulation/time_loop.h"

namespace drape::app {
namespace {

int first_not_finite(const State& state) {
  for (int i = 0; i < state.particles(); ++i)
    if (!state.x.segment<3>(3 * i).allFinite() || !state.v.segment<3>(3 * i).allFinite()) return i;
  return -1;
}

}  // namespace

TimeLoop::TimeLoop(Simulation& simulation, const Schedule& schedule)
    : simulation_(simulation), schedule_(schedule), number_(schedule.number()) {
  simulation_.state.time = schedule_.time();
}

const StepReport& TimeLoop::step() {
  State& state = simulation_.state;
  before_ = state;
  number_ = schedule_.number() + 1;
  const auto fail = [&](int particle) {
    if (report_.done) report_.failure = {"a position or velocity is not a finite number", particle, {}};
    report_.done = false;
  };
  report_ = {};
  if (const int bad = first_not_finite(state); bad >= 0) {  // set from outside
    fail(bad);
  } else {
    report_ = simulation_.advance(schedule_.next_step());
    if (const int late = first_not_finite(state); late >= 0) {  // out of the range of numbers
      fail(late);
      state = before_;
    }
  }
  failed_ = !report_.done;
  if (failed_) return report_;
  schedule_.advance();
  ++done_;
  state.time = schedule_.time();
  return report_;
}

}  // namespace drape::app
