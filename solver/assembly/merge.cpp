// Seams that have closed, and vertices at one place: their particles become one, and the system is made anew.
#include <algorithm>
#include <numeric>
#include <utility>

#include "solver/assembly/assembly.h"

namespace drape {

// The state after particles became one, with their momentum: number[i] is what particle i becomes, and masses
// [kg] are those of the new particles. A pinned particle stays where its first pin holds it.
State Assembly::merged_state(const std::vector<double>& masses, const std::vector<int>& number) const {
  const auto count = static_cast<Eigen::Index>(masses.size());
  State merged{state.time, VecX::Zero(3 * count), VecX::Zero(3 * count)};
  std::vector<int> parts(masses.size(), 0), pinned(masses.size(), -1);
  for (int n : number) ++parts[n];
  for (int i : constraints->pinned()) {
    int& first = pinned[number[i]];
    if (first < 0) first = i;
  }
  for (int i = 0; i < state.particles(); ++i) {
    const int to = number[i];
    const auto n = static_cast<std::size_t>(to);
    double share = 1;
    if (pinned[n] >= 0)
      share = pinned[n] == i ? 1 : 0;
    else if (parts[n] > 1)
      share = masses[n] > 0 ? system->masses()[i] / masses[n] : 1.0 / parts[n];
    merged.x.segment<3>(3 * to) += share * state.x.segment<3>(3 * i);
    merged.v.segment<3>(3 * to) += share * state.v.segment<3>(3 * i);
  }
  return merged;
}

bool Assembly::merge_closed_seams() {
  std::vector<Pairs> closed(cloths.size());
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    for (Cloth::Stitched& open : cloths[k].seams) {
      const Pairs pairs = open.seam.take_closed(cloths[k].embedding, state);
      closed[k].insert(closed[k].end(), pairs.begin(), pairs.end());
    }
    std::erase_if(cloths[k].seams, [](const Cloth::Stitched& open) { return open.seam.pairs.empty(); });
  }
  if (std::ranges::all_of(closed, &Pairs::empty)) return false;
  merge(closed);
  return true;
}

void Assembly::merge(const std::vector<Pairs>& pairs) {
  if (std::ranges::all_of(pairs, &Pairs::empty)) return;
  std::vector<int> number(static_cast<std::size_t>(state.particles()));
  std::iota(number.begin(), number.end(), 0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (!pairs[k].empty()) number = merged(number, pairs[k], cloths[k].embedding);
  std::vector<double> masses(1 + static_cast<std::size_t>(*std::max_element(number.begin(), number.end())),
                             0.0);
  for (std::size_t i = 0; i < number.size(); ++i) masses[number[i]] += system->masses()[i];
  State fewer = merged_state(masses, number);
  State before = std::exchange(state, std::move(fewer));
  if (keep_outgrown) outgrown.push_back(std::move(before));
  constraints->merge(number);
  Forces forces;
  for (Cloth& cloth : cloths) cloth.renumber(number);
  for (Cloth& cloth : cloths) connect(cloth, forces);
  make_system(std::move(masses), std::move(forces));
}

}  // namespace drape
