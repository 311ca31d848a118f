#include "constraints/filter.h"

#include <algorithm>

namespace drape {

void Filter::renumber(const std::vector<int>& number) {
  for (FilterEntry& e : entries_) e.particle = number[e.particle];
  std::sort(entries_.begin(), entries_.end(),
            [](const FilterEntry& a, const FilterEntry& b) { return a.particle < b.particle; });
}

}  // namespace drape
