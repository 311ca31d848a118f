#include "app/base/free_memory.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace drape::app {
namespace {

std::optional<double> number_in(const char* path) {  // none where it says "max"
  std::ifstream file(path);
  double value = 0;
  return file >> value ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<double> free_memory() {
  std::optional<double> free;
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;)
    if (double kilobytes = 0; word == "MemAvailable:" && info >> kilobytes) free = 1024 * kilobytes;
  const auto limit = number_in("/sys/fs/cgroup/memory.max"),
             used = number_in("/sys/fs/cgroup/memory.current");
  if (limit && used) free = std::min(free.value_or(*limit), std::max(0.0, *limit - *used));
  return free;
}

}  // namespace drape::app
