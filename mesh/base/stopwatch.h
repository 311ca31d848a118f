// A stopwatch adds the time for which it lives to a number of milliseconds when it is destroyed. That number
// must outlive the stopwatch: when the number belongs to a report that is returned by value, the stopwatch
// stands in a block of its own that ends before the return.
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
