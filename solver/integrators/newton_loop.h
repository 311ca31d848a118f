// How long Newton's iteration goes on, and with which stiffness: it takes as many steps as were asked for,
// and more until one is taken whole. After a step that had to be cut short, the next one uses the majorant.
#pragma once

#include "solver/integrators/integrator.h"

namespace drape::internal {

class NewtonLoop {
 public:
  explicit NewtonLoop(const StepOptions& options) : options_(options) {}

  bool next() { return ++k_ < options_.newton_iterations || !full_; }
  bool first() const { return k_ == 0; }
  bool exhausted() const { return k_ == options_.newton_iterations + options_.max_rescues; }
  bool may_stop() const { return k_ > 0 && full_; }  // when the residual is small enough
  Stiffness stiffness() const { return full_ || first() ? Stiffness::chord : Stiffness::majorant; }

  void took(bool full, StepReport& report) {
    ++report.newton_iterations;
    if (!full) ++report.rescues;
    full_ = full;
  }

 private:
  const StepOptions& options_;
  int k_ = -1;
  bool full_ = false;  // the last step was taken whole
};

}  // namespace drape::internal
