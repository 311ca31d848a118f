// The elements of a force, divided by the chunks of a pattern, so that two threads never write the same row.
#pragma once

#include <algorithm>
#include <vector>

#include "mesh/base/parallel.h"
#include "solver/matrix/block_pattern.h"

namespace drape {

class ChunkSchedule {
 public:
  // Divides the elements e = 0 .. count-1. first_row(e) must ascend, and all rows of an element must lie
  // within the bandwidth.
  template <class FirstRow>
  void bind(const BlockPattern& pattern, int count, const FirstRow& first_row) {
    start_.assign(static_cast<std::size_t>(pattern.chunks()) + 1, count);
    int chunk = -1;
    for (int e = 0; e < count; ++e)
      while (chunk < first_row(e) / pattern.chunk_rows()) start_[++chunk] = e;
    start_[0] = 0;
    for (std::size_t k = start_.size() - 1; k-- > 0;) start_[k] = std::min(start_[k], start_[k + 1]);
    serial_ = pattern.rows() < serial_below(Work::heavy);
  }

  // Calls f(e) for every element: first the even chunks in parallel, then the odd ones. When the schedule is
  // not bound, the elements are taken in order.
  template <class F>
  void run(int count, const F& f) const {
    if (start_.empty()) {
      for (int e = 0; e < count; ++e) f(e);
      return;
    }
    even_then_odd(static_cast<int>(start_.size()) - 1, serial_, [&](int k) {
      const auto chunk = static_cast<std::size_t>(k);
      for (int e = start_[chunk]; e < start_[chunk + 1]; ++e) f(e);
    });
  }

 private:
  std::vector<int> start_;
  bool serial_ = true;
};

}  // namespace drape
