// How much more memory this process could take: what the system reports as available, within the limit of the
// process's control group.
//   [Linux: MemAvailable of /proc/meminfo; memory.max and memory.current of cgroup v2]
#pragma once

#include <optional>

namespace drape::app {

std::optional<double> free_memory();  // bytes; empty when the system does not tell

}  // namespace drape::app
