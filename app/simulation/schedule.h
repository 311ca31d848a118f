// The times of the steps of a run: a whole number of equal steps from one frame to the next, so that frame k
// is the state at the time k / r. Without frames (r = 0) the steps are those that were asked for.
//   n      = ceil(1 / (r h))     steps to a frame; h [s]: the step asked for, r [1/s]: the frame rate
//   h_used = 1 / (r n) <= h      it is h itself, bit by bit, where n h is 1 / r to round-off
//   t_i    = (i div n) / r + (i mod n) h_used,  or i h where h_used is h: no sum that drifts by round-off
// A stretch of time counts as a whole number of steps when it is one to 1e-6 of a step.
#pragma once

#include <optional>

namespace drape::app {

// The times t_i.
class StepGrid {
 public:
  explicit StepGrid(double step, double frame_rate = 0);  // s, 1/s; 0: no frames

  double asked() const { return asked_; }        // s
  double step() const { return step_; }          // s, the step used
  long per_frame() const { return count_; }      // n; 0: no frames
  double frame_rate() const { return rate_; }    // 1/s
  bool as_asked() const;                         // whether the step used is the one asked for
  double time(long i) const;                     // s, t_i
  std::optional<long> index(double time) const;  // the i whose t_i is this time to 1e-6 of a step and 1 us
  double rounded(double time) const;             // s, t_i where the time is one, else the time itself

 private:
  double asked_, rate_, step_;
  long count_ = 0;
  bool multiples_ = true;  // t_i is i h
};

// The steps from a start to an end. The stretch from a start that is no frame to the first frame, and the
// stretch after the last frame, are shorter than the others. They too have equal steps, none longer than the
// one asked for. Without frames only the last step is shorter.
class Schedule {
 public:
  Schedule(const StepGrid& grid, double start, double end);  // s

  bool over() const { return done_ == steps_; }
  double time() const { return time_; }    // s, the present; a start that is a t_i to rounding is moved to it
  long number() const { return number_; }  // of steps until now, from t_0 where the start is on the grid
  double next_step() const;                // s, the length of the next step
  void advance();                          // to be called when that step is done
  std::optional<long> frame() const;       // the number of the frame that belongs to the present time
  const StepGrid& grid() const { return grid_; }

 private:
  void begin_stretch();
  void step_without_frames();
  void step_to(double target, std::optional<long> target_index);

  StepGrid grid_;
  double time_, end_;          // s
  std::optional<long> index_;  // of the grid, where the stretch began on it
  long number_ = 0;

  // The present stretch: up to the next frame, or to the end.
  double from_ = 0, target_ = 0, step_ = 0, last_step_ = 0;  // s
  bool along_grid_ = false;
  std::optional<long> target_index_;
  long steps_ = 0, done_ = 0;
};

}  // namespace drape::app
