#include "solver/forces/colours.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace drape {

void Colours::begin(int count) {
  colour_of_.assign(static_cast<std::size_t>(count), 0);
  lowest_.clear();
}

std::uint64_t Colours::give(int element, std::uint64_t taken) {
  const int colour = std::min(std::countr_one(taken), most);
  colour_of_[static_cast<std::size_t>(element)] = colour;
  return std::uint64_t{1} << colour;
}

void Colours::sort() {
  order_.resize(colour_of_.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto colour = [&](int e) { return colour_of_[static_cast<std::size_t>(e)]; };
  const auto place = [&](int e) {  // those of the last colour keep their order
    return std::pair(colour(e), colour(e) == most ? 0 : lowest_[static_cast<std::size_t>(e)]);
  };
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return place(a) < place(b); });
  start_.assign(1, 0);
  for (std::size_t k = 1; k <= order_.size(); ++k)
    if (k == order_.size() || colour(order_[k]) != colour(order_[k - 1]))
      start_.push_back(static_cast<int>(k));
  rest_in_turn_ = !order_.empty() && colour(order_.back()) == most;
}

}  // namespace drape
