#include "constraints/filter.h"

#include <algorithm>

namespace drape {

void Filter::renumber(const std::vector<int>& number) {
  for (FilterEntry& e : entries_) e.particle = number[e.particle];
  std::sort(entries_.begin(), entries_.end(),
            [](const FilterEntry& a, const FilterEntry& b) { return a.particle < b.particle; });
}

void Filter::apply(VecX& v) const {
  for (const FilterEntry& e : entries_)
    v.segment<3>(3 * e.particle) = (e.S * v.segment<3>(3 * e.particle)).eval();
}

void Filter::impose(VecX& dv) const {
  for (const FilterEntry& e : entries_)
    dv.segment<3>(3 * e.particle) = (e.S * dv.segment<3>(3 * e.particle) + e.z).eval();
}

}  // namespace drape
