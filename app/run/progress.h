// Shows on stderr how far a run is: as a bar with the time left when stderr is a terminal, and else as a line
// after every tenth of the run and after every minute. A step that takes long is told while it goes on.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/recording/steps_csv.h"

namespace drape::app {

class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  // duration of the run [s]. patience: a step that has taken that long is told, and again when it has taken
  // twice as long, or on a terminal a second later.
  Progress(double duration, bool quiet, Clock::duration patience = std::chrono::seconds(10),
           std::FILE* to = stderr);
  ~Progress() { end(); }

  void show(const StepRow& row);      // a step has ended
  void say(const std::string& line);  // prints a message between
  void end();                         // no step follows; takes the bar off the screen

 private:
  std::string status(Clock::time_point now) const;
  void draw_bar(Clock::time_point now, const std::string& more);
  void clear();
  void watch();      // what the thread does
  void tell_long();  // of the step that goes on

  const double duration_;
  const bool quiet_, terminal_;
  const Clock::duration patience_;
  std::FILE* const to_;

  std::mutex mutex_;  // of all that follows, and of to_
  std::condition_variable changed_;
  bool over_ = false, bar_drawn_ = false;
  int tenths_shown_ = 0;
  std::optional<StepRow> last_;                                               // the step that ended last
  Clock::time_point start_ = Clock::now(), drawn_ = start_, since_ = start_;  // since_: when that was
  Clock::duration wait_;  // from since_ on, until the step that goes on is told
  std::thread watch_;
};

}  // namespace drape::app
