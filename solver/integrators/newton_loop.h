// How long Newton's iteration goes on, and with which stiffness: it takes as many steps as were asked for,
// and more until one is taken whole. Where edges go slack the first may overshoot: what was slack where it
// was linearised has become taut, and the next one knows that. After a step that had to be cut short, the
// next one uses the majorant. A motion that makes energy goes on with the stiffness that it has, twice at
// most. In a step of order 1 in the place of one of order 2 it goes on with the majorant, max_rescues times
// at most, until it makes none.
#pragma once

#include <algorithm>

#include "solver/integrators/integrator.h"
#include "solver/integrators/merit.h"

namespace drape::internal {

class NewtonLoop {
 public:
  NewtonLoop(const StepOptions& options, bool goes_slack) : options_(options), goes_slack_(goes_slack) {}

  bool next() {
    ++k_;
    return k_ < options_.newton_iterations || taken_ != StepTaken::whole || (makes_energy_ && k_ < most()) ||
           (refines_ && k_ < std::min(options_.newton_iterations + most_refined, most()));
  }
  bool first() const { return k_ == 0; }
  bool exhausted() const { return k_ == most(); }
  bool may_stop() const { return k_ > 0 && taken_ == StepTaken::whole; }  // when the residual is small enough
  bool may_overshoot() const { return first() && goes_slack_; }
  // Whether the next step is judged against a cloth at rest in any case, and not against where the last one
  // ended.
  bool from_rest() const { return first() || taken_ == StepTaken::overshot; }
  Stiffness stiffness() const {
    const bool sound = from_rest() || (taken_ == StepTaken::whole && !makes_energy_);
    return sound ? Stiffness::chord : Stiffness::majorant;
  }

  // refines: the motion makes energy, and the next step is to find out whether that is only what
  // linearisation left.
  void took(StepTaken taken, bool makes_energy, bool refines, StepReport& report) {
    ++report.newton_iterations;
    if (taken != StepTaken::whole || makes_energy) ++report.rescues;
    taken_ = taken;
    makes_energy_ = makes_energy;
    refines_ = refines;
  }

 private:
  static constexpr int most_refined = 2;
  int most() const { return options_.newton_iterations + options_.max_rescues; }

  const StepOptions& options_;
  bool goes_slack_;
  int k_ = -1;
  StepTaken taken_ = StepTaken::cut;  // the last step
  bool makes_energy_ = false;         // and so far the motion makes energy
  bool refines_ = false;              // the last step makes energy, and the next one refines it
};

}  // namespace drape::internal
