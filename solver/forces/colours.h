// Elements in groups, the colours: no two of a colour touch the same particle, so that those of a colour can be taken at the
// same time. The colours depend on the elements and their order only, never on the number of threads.
//                                                                              [greedy colouring; Matula & Beck 1983]
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/base/parallel.h"

namespace drape {

class Colours {
 public:
  // Colours the elements 0 .. count-1. each_particle(e, f) calls f(particle) for the particles of element e, which are
  // below `particles`.
  template <class EachParticle>
  void make(int count, int particles, const EachParticle& each_particle) {
    std::vector<std::uint64_t> taken(static_cast<std::size_t>(particles), 0);
    begin(count);
    for (int e = 0; e < count; ++e) {
      std::uint64_t all = 0;
      each_particle(e, [&](int p) { all |= taken[static_cast<std::size_t>(p)]; });
      const std::uint64_t mine = give(e, all);
      each_particle(e, [&](int p) { taken[static_cast<std::size_t>(p)] |= mine; });
    }
    sort();
  }

  // The elements, colour by colour, in ascending order within each.
  const std::vector<int>& order() const { return order_; }
  int colours() const { return static_cast<int>(start_.size()) - 1; }

  // Calls f(k) for every place k of order(): one colour after the other, those of a colour in any order.
  template <class F>
  void run(const F& f) const {
    constexpr int block = 512, parallel_from = 4 * block;
    for (std::size_t colour = 0; colour + 1 < start_.size(); ++colour) {
      const int first = start_[colour], count = start_[colour + 1] - first;
      const bool serial = count < parallel_from || (rest_in_turn_ && colour + 2 == start_.size());
      parallel_for((count + block - 1) / block, serial, [&](int b) {
        const int end = first + std::min(count, (b + 1) * block);
        for (int k = first + b * block; k < end; ++k) f(k);
      });
    }
  }

 private:
  // The last of the 64 is no colour: it has the elements for which there was none, and they are taken in turn.
  static constexpr int most = 63;

  void begin(int count);
  std::uint64_t give(int element, std::uint64_t taken);  // its colour, as a bit
  void sort();

  std::vector<int> colour_of_, order_, start_;
  bool rest_in_turn_ = false;
};

}  // namespace drape
