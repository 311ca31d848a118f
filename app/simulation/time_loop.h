// The loop over time: steps are taken here, and nowhere else.
#pragma once

#include "app/base/interrupt.h"
#include "app/simulation/schedule.h"
#include "app/simulation/simulation.h"

namespace drape::app {

// Takes a simulation through a schedule, one step at a time. Keeps a reference to the simulation.
class TimeLoop {
 public:
  TimeLoop(Simulation& simulation, const Schedule& schedule);

  bool over() const { return schedule_.over() || failed_; }
  // Takes the next step; must not be called when over(). When the step fails, or leaves a number that is not
  // finite, the report says so, the state is as it was before, and the loop is over.
  const StepReport& step();
  long number() const { return number_; }  // of the last step that was tried, as Schedule counts
  long done() const { return done_; }      // steps done by this loop
  const Schedule& schedule() const { return schedule_; }

 private:
  Simulation& simulation_;
  Schedule schedule_;
  State before_;  // the state before the present step
  StepReport report_;
  long number_ = 0, done_ = 0;
  bool failed_ = false;
};

// Steps until the loop is over, until Ctrl-C, or until `go_on` returns false for what step() returned.
template <class Steps, class GoOn>
void march(Steps& steps, const GoOn& go_on) {
  while (!steps.over() && !interrupted() && go_on(steps.step())) continue;
}

}  // namespace drape::app
