// Elements in groups, the colours: no two of a colour touch the same particle, so that those of a colour can
// be taken at the same time. The colours depend on the elements and their order only, never on the number of
// threads.
//                                                                              [greedy colouring; Matula & Beck 1983]
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/base/parallel.h"

namespace drape {

class Colours {
 public:
  // Colours the elements 0 .. count-1. each_particle(e, f) calls f(particle) for the particles of element e,
  // which are below `particles`.
  template <class EachParticle>
  void make(int count, int particles, const EachParticle& each_particle) {
    std::vector<std::uint64_t> taken(static_cast<std::size_t>(particles), 0);
    begin(count);
    for (int e = 0; e < count; ++e) {
      std::uint64_t all = 0;
      int lowest = particles;
      each_particle(e, [&](int p) {
        all |= taken[static_cast<std::size_t>(p)];
        lowest = std::min(lowest, p);
      });
      lowest_.push_back(lowest);
      const std::uint64_t mine = give(e, all);
      each_particle(e, [&](int p) { taken[static_cast<std::size_t>(p)] |= mine; });
    }
    sort();
  }

  // The elements, colour by colour; within each by their lowest particles, so that places next to each other
  // are read together.
  const std::vector<int>& order() const { return order_; }
  int colours() const { return static_cast<int>(start_.size()) - 1; }

  // Takes the places of order() in ranges [begin, end): one colour after the other, those of a colour in any
  // order. Of what apart(begin, end) is called for, no two touch the same particle; in_turn(begin, end) has
  // to keep to the order.
  template <class Apart, class InTurn>
  void run(const Apart& apart, const InTurn& in_turn) const {
    constexpr int block = 512, parallel_from = 4 * block;
    for (std::size_t colour = 0; colour + 1 < start_.size(); ++colour) {
      const int first = start_[colour], last = start_[colour + 1], count = last - first;
      if (rest_in_turn_ && colour + 2 == start_.size())
        in_turn(first, last);
      else
        parallel_for((count + block - 1) / block, count < parallel_from,
                     [&](int b) { apart(first + b * block, std::min(last, first + (b + 1) * block)); });
    }
  }

 private:
  // The last of the 64 is no colour: it has the elements for which there was none, and they are taken in
  // turn.
  static constexpr int most = 63;

  void begin(int count);
  std::uint64_t give(int element, std::uint64_t taken);  // its colour, as a bit
  void sort();

  std::vector<int> colour_of_, lowest_, order_, start_;
  bool rest_in_turn_ = false;
};

}  // namespace drape
