#include "app/base/peak_memory.h"

#include <algorithm>
#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace drape::app {
namespace {

// "VmRSS:    1234 kB" of /proc/self/status, in bytes.
std::optional<double> status(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key + ":")) return 1024 * std::stod(line.substr(key.size() + 1));
  return {};
}

bool set_peak_back() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

void give_back_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace

PeakMemory::PeakMemory() {
  give_back_freed_memory();
  if (set_peak_back()) before_ = status("VmRSS");
}

std::optional<double> PeakMemory::bytes() const {
  const std::optional<double> peak = status("VmHWM");
  if (!before_ || !peak) return {};
  return std::max(0.0, *peak - *before_);
}

std::optional<double> PeakMemory::kept() const {
  give_back_freed_memory();
  const std::optional<double> now = status("VmRSS");
  if (!before_ || !now) return {};
  return *now - *before_;
}

}  // namespace drape::app
