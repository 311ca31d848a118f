// Shows on stderr how far a run is: as a bar with the time left when stderr is a terminal, and else as a line
// after every tenth of the run.
#pragma once

#include <chrono>
#include <string>

#include "app/recording/steps_csv.h"

namespace drape::app {

class Progress {
 public:
  Progress(double duration, bool quiet);  // duration of the run [s]
  ~Progress();

  void show(const StepRow& row);
  void say(const std::string& line);  // prints a message between
  void clear();                       // takes the bar off the screen

 private:
  using Clock = std::chrono::steady_clock;
  std::string status(const StepRow& row) const;
  void draw_bar(const StepRow& row);

  double duration_;
  bool quiet_, terminal_, bar_drawn_ = false;
  int tenths_shown_ = 0;
  Clock::time_point start_ = Clock::now(), drawn_ = {};
};

}  // namespace drape::app
