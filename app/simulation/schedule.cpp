#include "app/simulation/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::app {
namespace {

constexpr double whole = 1e-6;  // of a step: what is less than that off is not off

// How many steps of h fill a stretch of time; the last may be shorter.
long steps_to_fill(double stretch, double h) {
  const double exact = std::min(stretch / h, 1e18);
  return std::max(1L, static_cast<long>(std::ceil(exact - whole * std::max(1.0, exact))));
}

// i div n, rounded down: times may be negative.
long frame_before(long i, long n) { return i >= 0 ? i / n : -((n - 1 - i) / n); }

}  // namespace

StepGrid::StepGrid(double step, double frame_rate) : asked_(step), rate_(frame_rate), step_(step) {
  if (!(rate_ > 0)) return;
  constexpr double round_off = 8 * std::numeric_limits<double>::epsilon();
  const double interval = 1 / rate_;
  count_ = steps_to_fill(interval, step);
  multiples_ = std::abs(static_cast<double>(count_) * step - interval) <= round_off * interval;
  if (!multiples_) step_ = interval / static_cast<double>(count_);
}

bool StepGrid::as_asked() const { return std::abs(step_ - asked_) <= whole * asked_; }

double StepGrid::time(long i) const {
  if (multiples_) return static_cast<double>(i) * step_;
  const long frame = frame_before(i, count_);
  return static_cast<double>(frame) / rate_ + static_cast<double>(i - frame * count_) * step_;
}

std::optional<long> StepGrid::index(double t) const {
  const double nearest = std::round(t / step_);
  if (!(std::abs(nearest) < 1e15)) return {};
  const long i = std::lround(nearest);
  if (std::abs(t - time(i)) <= whole * std::min(step_, 1.0)) return i;
  return {};
}

double StepGrid::rounded(double t) const {
  const std::optional<long> i = index(t);
  return i ? time(*i) : t;
}

Schedule::Schedule(const StepGrid& grid, double start, double end)
    : grid_(grid), time_(grid.rounded(start)), end_(end), index_(grid.index(start)) {
  number_ = index_.value_or(0);
  begin_stretch();
}

void Schedule::begin_stretch() {
  from_ = time_;
  steps_ = done_ = 0;
  if (!(end_ - time_ > whole * grid_.step())) return;
  if (grid_.per_frame() == 0) return step_without_frames();
  const long n = grid_.per_frame();
  const long before =
      index_ ? frame_before(*index_, n) : static_cast<long>(std::floor(time_ * grid_.frame_rate()));
  const long at = (before + 1) * n;
  if (const double time = grid_.time(at); time < end_ - whole * grid_.step())
    step_to(time, at);
  else
    step_to(end_, grid_.index(end_));
}

void Schedule::step_without_frames() {
  const double stretch = end_ - time_, exact = stretch / grid_.step();
  steps_ = steps_to_fill(stretch, grid_.step());
  step_ = last_step_ = grid_.step();
  const auto count = static_cast<double>(steps_);
  if (std::abs(exact - count) > whole * std::max(1.0, exact)) last_step_ = stretch - step_ * (count - 1);
  target_ = end_;
  along_grid_ = index_.has_value();
  target_index_ = grid_.index(end_);
}

void Schedule::step_to(double target, std::optional<long> target_index) {
  target_ = target;
  target_index_ = target_index;
  along_grid_ = index_ && target_index;
  steps_ = along_grid_ ? *target_index - *index_ : steps_to_fill(target - time_, grid_.asked());
  step_ = last_step_ = along_grid_ ? grid_.step() : (target - time_) / static_cast<double>(steps_);
}

double Schedule::next_step() const { return done_ + 1 == steps_ ? last_step_ : step_; }

void Schedule::advance() {
  ++done_;
  ++number_;
  if (done_ == steps_) {
    time_ = target_;
    index_ = target_index_;
    return begin_stretch();
  }
  time_ = along_grid_ ? grid_.time(*index_ + done_) : from_ + static_cast<double>(done_) * step_;
}

std::optional<long> Schedule::frame() const {
  if (grid_.per_frame() == 0 || done_ > 0 || !index_ || *index_ < 0 || *index_ % grid_.per_frame() != 0)
    return {};
  return *index_ / grid_.per_frame();
}

}  // namespace drape::app
