#include "app/run/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace drape::app {
namespace {

int terminal_width() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
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

}  // namespace

Progress::Progress(double duration, bool quiet)
    : duration_(duration), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() { clear(); }

std::string Progress::status(const StepRow& row) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left = row.time > 0 ? elapsed * std::max(0.0, duration_ - row.time) / row.time : 0;
  char text[200];
  std::snprintf(text, sizeof text,
                "%3.0f %%  %.3g of %.3g s  left %s  speed %.2g m/s  contacts %d  iterations %d  %.3g ms/step",
                100 * row.time / duration_, row.time, duration_, clock_text(left).c_str(), row.max_speed,
                row.report.contacts, row.report.linear_iterations,
                1000 * elapsed / static_cast<double>(std::max(1L, row.step)));
  return text;
}

void Progress::show(const StepRow& row) {
  if (quiet_) return;
  if (terminal_) {
    draw_bar(row);
    return;
  }
  const int tenths = static_cast<int>(10 * row.time / duration_ + 1e-9);
  if (tenths <= tenths_shown_) return;
  tenths_shown_ = tenths;
  std::fprintf(stderr, "%s\n", status(row).c_str());
}

void Progress::draw_bar(const StepRow& row) {
  const auto now = Clock::now();
  if (bar_drawn_ && now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  bar_drawn_ = true;
  constexpr int cells = 20;
  const int full = std::clamp(static_cast<int>(cells * row.time / duration_), 0, cells);
  std::string line = "[" + std::string(static_cast<std::size_t>(full), '#') +
                     std::string(static_cast<std::size_t>(cells - full), ' ') + "] " + status(row);
  line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(1, terminal_width() - 1))));
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
}

void Progress::clear() {
  if (bar_drawn_) std::fputs("\r\033[K", stderr);
  bar_drawn_ = false;
}

void Progress::say(const std::string& line) {
  if (quiet_) return;
  clear();
  std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace drape::app
