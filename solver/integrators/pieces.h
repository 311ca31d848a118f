// A step that fails whole is taken in halves, those again in halves, at most max_halvings times; and none of
// it is done when the shortest piece fails, too.
#pragma once

#include <cmath>

#include "solver/integrators/integrator.h"

namespace drape {

struct Piece {
  double h;       // s
  bool whole;     // it is all of the step
  bool shortest;  // it will not be halved
};

// attempt(piece) takes `state` on by the piece, or returns false and leaves it. `before` is where a step that
// fails half-way returns to; it is the caller's, so that nothing is allocated.
template <class Attempt>
void take_in_pieces(State& state, double h, int max_halvings, State& before, StepReport& report,
                    const Attempt& attempt) {
  const double end = state.time + h;
  int halvings = 0, left = 1;
  report.substeps = 0;
  while (left > 0) {
    if (attempt(Piece{std::ldexp(h, -halvings), halvings == 0, halvings == max_halvings})) {
      --left;
      ++report.substeps;
      continue;
    }
    if (halvings == 0) before = state;
    if (halvings == max_halvings) {
      state = before;
      report.done = false;
      return;
    }
    ++halvings;
    left *= 2;
  }
  state.time = end;
  report.failure = {};
}

}  // namespace drape
