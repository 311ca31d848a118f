#include "app/run/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "app/base/words.h"

namespace drape::app {
namespace {

using Clock = Progress::Clock;

int terminal_width(std::FILE* terminal) {
  winsize size = {};
  return ioctl(fileno(terminal), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string clock_text(double seconds) {
  const long whole = std::lround(std::min(seconds, 1e8));
  char text[32];
  if (whole < 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return text;
}

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

Progress::Progress(double duration, bool quiet, Clock::duration patience, std::FILE* to)
    : duration_(duration),
      quiet_(quiet),
      terminal_(isatty(fileno(to)) == 1),
      patience_(patience),
      to_(to),
      wait_(patience) {
  if (!quiet_) watch_ = std::thread([this] { watch(); });
}

void Progress::show(const StepRow& row) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  last_ = row;
  since_ = now;
  if (wait_ != patience_) changed_.notify_one();  // the thread waits for longer than it now has to
  wait_ = patience_;
  if (terminal_) {
    if (!bar_drawn_ || now - drawn_ >= std::chrono::milliseconds(100)) draw_bar(now, {});
    return;
  }
  const int tenths = static_cast<int>(10 * row.time / duration_ + 1e-9);
  if (tenths <= tenths_shown_ && now - drawn_ < 6 * patience_) return;
  tenths_shown_ = tenths;
  drawn_ = now;
  std::fprintf(to_, "%s\n", status(now).c_str());
}

void Progress::say(const std::string& line) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  clear();
  std::fprintf(to_, "%s\n", line.c_str());
}

void Progress::end() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
    clear();
  }
  changed_.notify_one();
  if (watch_.joinable()) watch_.join();
}

std::string Progress::status(Clock::time_point now) const {
  const double elapsed = seconds(now - start_);
  const double left = last_->time > 0 ? elapsed * std::max(0.0, duration_ - last_->time) / last_->time : 0;
  char text[200];
  std::snprintf(text, sizeof text,
                "%3.0f %%  %.3g of %.3g s  left %s  speed %.2g m/s  contacts %d  iterations %d  %.3g ms/step",
                100 * last_->time / duration_, last_->time, duration_, clock_text(left).c_str(),
                last_->max_speed, last_->report.contacts, last_->report.linear_iterations,
                1000 * elapsed / static_cast<double>(std::max(1L, last_->step)));
  return text;
}

void Progress::draw_bar(Clock::time_point now, const std::string& more) {
  drawn_ = now;
  bar_drawn_ = true;
  constexpr int cells = 20;
  const int full = last_ ? std::clamp(static_cast<int>(cells * last_->time / duration_), 0, cells) : 0;
  std::string line = "[" + std::string(static_cast<std::size_t>(full), '#') +
                     std::string(static_cast<std::size_t>(cells - full), ' ') + "] " + more;
  if (last_) line += status(now);
  line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(1, terminal_width(to_) - 1))));
  std::fprintf(to_, "\r%s\033[K", line.c_str());
  std::fflush(to_);
}

void Progress::clear() {
  if (bar_drawn_) std::fputs("\r\033[K", to_);
  bar_drawn_ = false;
}

void Progress::watch() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    changed_.wait_until(lock, since_ + wait_);
    if (over_ || Clock::now() < since_ + wait_) continue;
    tell_long();
    wait_ = terminal_ ? wait_ + std::min<Clock::duration>(patience_, std::chrono::seconds(1)) : 2 * wait_;
  }
}

void Progress::tell_long() {
  const auto now = Clock::now();
  const std::string step = "step " + std::to_string(last_ ? last_->step + 1 : 1),
                    so_far = rounded(seconds(now - since_), 3) + " s";
  if (terminal_) return draw_bar(now, step + " has taken " + clock_text(seconds(now - since_)) + " so far  ");
  drawn_ = now;
  std::fprintf(to_, "%s (from %s s) has taken %s so far and goes on\n", step.c_str(),
               rounded(last_ ? last_->time : 0, 4).c_str(), so_far.c_str());
}

}  // namespace drape::app
