// A run of a simulation from its start to its end: steps, frames, messages, output files. The command line and
// Python both run through it.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "app/recording/output.h"
#include "app/run/progress.h"
#include "app/simulation/time_loop.h"

namespace drape::app {

struct RunOptions {
  std::filesystem::path out;  // empty: no files
  Frames frames = Frames::pc2;
  bool quiet = false;
  std::optional<double> duration = {};  // s, from where the simulation is; unset: to the end of the scene
  // s; unset: the scene's, shortened where a frame comes sooner. Given: steps of just this length, which pass
  // over the times of frames; the last state is the only frame.
  std::optional<double> time_step = {};
};

// Starts where the simulation is. Keeps a reference to it.
class Run {
 public:
  Run(Simulation& simulation, const RunOptions& options);  // throws InputError
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  bool over() const { return loop_.over() || settled_; }
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

  void describe();
  bool at_rest(const StepRow& row) const;
  bool slow(double cloth_speed) const;
  void record_step(const StepRow& row);
  void watch_settling();
  void write_due_frame();
  void write_frame();
  void note_failure(const StepFailure& failure);
  void tell_once(bool& told, const std::string& line);
  void tell_of_open_seams();

  const SimulationOptions& wanted_;
  Simulation& simulation_;
  const StepGrid grid_;
  const double end_time_;  // s
  TimeLoop loop_;
  std::optional<Output> output_;
  Progress progress_;
  RunRecord record_;
  StepRow row_;
  Clock::time_point start_ = Clock::now();
  bool framed_ = false;  // there is a frame of the state as it is now
  bool settled_ = false;
  double last_motion_;         // s
  double settled_since_ = -1;  // s, -1: it moves
  bool told_cut_ = false, told_not_converged_ = false;
  std::string failure_;
};

// To its end, with its messages. Exit code: 0 done, 1 the computation failed, 130 interrupted. Throws
// InputError.
int run(const Scene& scene, const RunOptions& options);

}  // namespace drape::app
