// The law that a motion has the same bits on any number of threads.
#pragma once

#include <catch2/catch.hpp>

#include "tests/tables.h"

namespace drape::test {

// motion() makes everything anew and returns the state at its end.
template <class Motion>
void check_same_bits(const Motion& motion) {
  const ThreadsRestored restored;
  State first;
  for (int t : {1, 2, 7}) {
    set_threads(t);
    const State state = motion();
    if (t == 1) first = state;
    INFO(t << " threads");
    CHECK(same_bits(state.x, first.x));
    CHECK(same_bits(state.v, first.v));
  }
}

// A soft sheet held at a corner, above the size where threads begin.
struct LargeSheet : Sheet {
  LargeSheet()
      : Sheet(grid(64, 64, 1, 1), {.area_density = 0.2, .stretch = 20, .bend = 1e-6, .damping = 1e-3}) {
    constraints.pin(0);
  }
};

}  // namespace drape::test
