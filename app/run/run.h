// A run of a simulation from its start to its end: steps, frames, messages, output files. The command line
// and Python both run through it.
#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "app/recording/output.h"
#include "app/run/progress.h"
#include "app/simulation/time_loop.h"

namespace drape::app {

struct RunOptions {
  std::filesystem::path out;  // empty: no files
  Frames frames = Frames::pc2;
  bool quiet = false;
  std::optional<double> duration = {};  // s, from the present time; unset: to the end of the scene
  // Time step [s]. Unset: the step of the scene, shortened where a frame comes sooner. Given: all steps have
  // exactly this length and pass over the times of frames; the last state is then the only frame.
  std::optional<double> time_step = {};
};

// A run begins at the present state of the simulation. It keeps a reference to the simulation.
class Run {
 public:
  Run(Simulation& simulation, const RunOptions& options);  // throws InputError
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  bool over() const { return loop_.over() || settled_; }
  // Takes the next step and writes the frames that are due with it; must not be called when over(). When the
  // step fails, the state and its numbers are those from before the step.
  const StepRow& step();
  // Why the run ended early: "step 7 (from 0.06 s) failed: ..."; empty when it did not fail.
  const std::string& failure() const { return failure_; }
  // Writes the last frame and gives all files their names. A run that is not over() is recorded as
  // interrupted. Call it only once.
  const RunRecord& finish();
  std::string summary() const;  // only after finish()

 private:
  using Clock = std::chrono::steady_clock;

  void describe();
  void describe_rope(const RopeEntry& entry, const Cloth& rope, const Json& pins);
  void describe_tears();
  bool at_rest(const StepRow& row) const;
  bool slow(double cloth_speed) const;
  void record_step(const StepRow& row);
  void watch_settling();
  void count_crossings();
  void tell_of_crossings(int crossings);
  void write_due_frame();
  void write_frame();
  void note_failure(const StepFailure& failure);
  void tell_once(bool& told, const std::string& line);
  void tell_of_open_seams();
  void tell_of_misses();

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
  std::vector<double> strain_of_triangles_;  // scratch
  VecX x_before_;                            // at the start of the step [m]
  // The longest way of a particle in the last step, over the length of the step [m/s]: moves without velocity
  // count.
  double fastest_way_ = 0;
  bool framed_ = false;  // there is a frame of the present state
  bool settled_ = false;
  double last_motion_;         // s
  double settled_since_ = -1;  // s; -1: something moves
  bool told_cut_ = false, told_not_converged_ = false, told_still_ = false, told_crossings_ = false;
  const bool from_start_;                    // the run begins at time 0
  bool touched_ = false;                     // anything, at the end of a step
  std::vector<Eigen::AlignedBox3d> begins_;  // about each cloth [m]
  std::string failure_;
};

// Runs the scene to its end and prints its messages. Exit code: 0 done, 1 the computation failed, 130
// interrupted. Throws InputError.
int run(const Scene& scene, const RunOptions& options);

}  // namespace drape::app
