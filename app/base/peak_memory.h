// How much the resident memory of this process rises above where it stood, at most, while something runs.
//   Linux: VmHWM of /proc/self/status, set back by writing 5 to /proc/self/clear_refs [proc(5)]; memory that
//   is freed but still kept by the allocator is given back first. Elsewhere nothing is measured.
#pragma once

#include <optional>

namespace drape {

class PeakMemory {
 public:
  PeakMemory();                         // starts to watch
  std::optional<double> bytes() const;  // the highest rise since; empty: cannot be measured here
  std::optional<double> kept() const;   // the rise that is still there; negative: less than there was

 private:
  std::optional<double> before_;  // bytes
};

}  // namespace drape
