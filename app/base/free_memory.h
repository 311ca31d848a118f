// How much memory this process could still take: what the system says is available, within the limit of its
// control group.    [Linux: MemAvailable of /proc/meminfo; memory.max and memory.current of cgroup v2]
#pragma once

#include <optional>

namespace drape {

std::optional<double> free_memory();  // bytes; empty: not known here

}  // namespace drape
