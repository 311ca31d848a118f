// How long Newton's iteration goes on, and with which stiffness: it takes as many steps as were asked for,
// and more until one is taken whole. After a step that had to be cut short, the next one uses the majorant.
// The same is done, max_rescues times at most, while the motion that the iteration came to makes energy.
#pragma once

#include "solver/integrators/integrator.h"

namespace drape::internal {

class NewtonLoop {
 public:
  explicit NewtonLoop(const StepOptions& options) : options_(options) {}

  bool next() {
    ++k_;
    return k_ < options_.newton_iterations || !full_ || (makes_energy_ && k_ < most());
  }
  bool first() const { return k_ == 0; }
  bool exhausted() const { return k_ == most(); }
  bool may_stop() const { return k_ > 0 && full_; }  // when the residual is small enough
  Stiffness stiffness() const {
    return first() || (full_ && !makes_energy_) ? Stiffness::chord : Stiffness::majorant;
  }

  void took(bool full, bool makes_energy, StepReport& report) {
    ++report.newton_iterations;
    if (!full || makes_energy) ++report.rescues;
    full_ = full;
    makes_energy_ = makes_energy;
  }

 private:
  int most() const { return options_.newton_iterations + options_.max_rescues; }

  const StepOptions& options_;
  int k_ = -1;
  bool full_ = false;          // the last step was taken whole
  bool makes_energy_ = false;  // and so far the motion makes energy
};

}  // namespace drape::internal
