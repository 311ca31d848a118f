// Measures by how much the resident memory of this process rises at most while something runs.
//   Linux: VmHWM of /proc/self/status, reset by writing 5 to /proc/self/clear_refs [proc(5)]. Memory that is
//   freed but still kept by the allocator is first given back. Other systems: nothing is measured.
#pragma once

#include <optional>

namespace drape::app {

class PeakMemory {
 public:
  PeakMemory();                         // starts the measurement
  std::optional<double> bytes() const;  // the highest rise since the start; empty when it cannot be measured
  // The rise that remains; negative when there is less memory in use than before.
  std::optional<double> kept() const;

 private:
  std::optional<double> before_;  // bytes
};

}  // namespace drape::app
