// How long Newton's iteration goes on, and with which stiffness: it takes as many steps as were asked for,
// and more until one is taken whole. The first may overshoot: edges that were slack where it was linearised have
// become taut, and the next one knows them. After a step that had to be cut short, the next one uses the majorant.
// The same is done, max_rescues times at most, while the motion that the iteration came to makes energy.
#pragma once

#include "solver/integrators/integrator.h"
#include "solver/integrators/merit.h"

namespace drape::internal {

class NewtonLoop {
 public:
  explicit NewtonLoop(const StepOptions& options) : options_(options) {}

  bool next() {
    ++k_;
    return k_ < options_.newton_iterations || taken_ != Taken::whole || (makes_energy_ && k_ < most());
  }
  bool first() const { return k_ == 0; }
  bool exhausted() const { return k_ == most(); }
  bool may_stop() const { return k_ > 0 && taken_ == Taken::whole; }  // when the residual is small enough
  bool may_overshoot() const { return first(); }
  // Whether the next step is judged against standing still, and not against where the last one ended.
  bool from_standing() const { return first() || taken_ == Taken::overshot; }
  Stiffness stiffness() const {
    const bool sound = from_standing() || (taken_ == Taken::whole && !makes_energy_);
    return sound ? Stiffness::chord : Stiffness::majorant;
  }

  void took(Taken taken, bool makes_energy, StepReport& report) {
    ++report.newton_iterations;
    if (taken != Taken::whole || makes_energy) ++report.rescues;
    taken_ = taken;
    makes_energy_ = makes_energy;
  }

 private:
  int most() const { return options_.newton_iterations + options_.max_rescues; }

  const StepOptions& options_;
  int k_ = -1;
  Taken taken_ = Taken::cut;   // the last step
  bool makes_energy_ = false;  // and so far the motion makes energy
};

}  // namespace drape::internal
