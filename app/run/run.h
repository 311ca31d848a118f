// A run of a simulation from its start to its end: steps, frames, messages, output files. One time loop for
// the command line and for Python.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "app/recording/output.h"
#include "app/run/progress.h"

namespace drape {

struct RunOptions {
  std::filesystem::path out;  // empty: no files
  Frames frames = Frames::pc2;
  bool quiet = false;
  // s, from where the simulation is; none: what is left of the scene's, and the scene's.
  std::optional<double> duration = {}, time_step = {};
};

// Starts where the simulation is. Keeps a reference to it.
class Run {
 public:
  Run(Simulation& simulation, const RunOptions& options);  // throws InputError
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  bool over() const { return at_end() || settled_ || record_.failure; }
  // The next step, and the frames that are due with it; not when it is over. When it fails, the state and its
  // numbers are those from before.
  const StepRow& step();
  // Why it is over before its end: "step 7 (from 0.06 s) failed: ..."; empty: it did not fail.
  const std::string& failure() const { return failure_; }
  // The last frame and the files, which appear now. Interrupted, when it is not over. Once.
  const RunRecord& finish();
  std::string summary() const;  // after that

 private:
  using Clock = std::chrono::steady_clock;

  void plan(bool until_duration);
  void describe();
  double time_after(long step) const;  // s
  bool at_rest(const StepRow& row) const;
  bool slow(double cloth_speed) const;
  void record_step(const StepRow& row);
  void watch_settling();
  void write_due_frames();
  void write_frame();
  bool at_last_step() const { return next_step_ == step_count_; }
  bool at_end() const { return next_step_ > step_count_; }
  void note_failure(const StepFailure& failure);
  void tell_once(bool& told, const std::string& line);
  void tell_of_open_seams();

  const SimulationOptions& wanted_;
  Simulation& simulation_;
  std::optional<Output> output_;
  double h_, start_time_, end_time_;  // s
  Progress progress_;
  RunRecord record_;
  StepRow row_;
  State before_;  // the step under way
  Clock::time_point start_ = Clock::now();
  long step_count_ = 0, next_step_ = 1;
  long steps_before_ = 0;  // of the same length, when the start is a whole number of them
  long next_frame_ = 0;
  bool framed_ = false, settled_ = false;
  double last_motion_;         // s
  double last_step_ = 0;       // s, of the last step
  double settled_since_ = -1;  // s, -1: it moves
  bool told_cut_ = false, told_not_converged_ = false;
  std::string failure_;
};

// To its end, with its messages. Exit code: 0 done, 1 the computation failed, 130 interrupted. Throws
// InputError.
int run(const Scene& scene, const RunOptions& options);

}  // namespace drape
