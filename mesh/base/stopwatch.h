// Adds the time it lives to a number of milliseconds when it dies. The number must outlive it: when it belongs
// to a report that is returned by value, the stopwatch dies in a block of its own before the return. Internal
// to the library (not installed).
#pragma once

#include <chrono>

namespace drape {

class Stopwatch {
 public:
  explicit Stopwatch(double& ms) : ms_(ms), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& ms_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace drape
