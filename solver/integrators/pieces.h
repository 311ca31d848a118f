// Takes a step in pieces: a step that fails as a whole is taken in halves, and those again in halves, at most
// max_halvings times. When the shortest piece fails, too, the state returns to where the step began.
#pragma once

#include <cmath>

#include "solver/integrators/integrator.h"

namespace drape {

struct Piece {
  double h;              // s
  int halvings;          // of the step, which this piece is a part of; 0: the piece is all of the step
  bool shortest;         // the piece will not be halved
  bool order_1 = false;  // the piece is taken by order 1, whatever the integrator
  double of_step() const { return std::ldexp(h, halvings); }  // the length of the whole step [s]
};

// attempt(piece) takes `state` on by the piece, or returns false and leaves the state as it is. `before` is
// the state to which a step that fails half-way returns; it belongs to the caller, so that nothing is
// allocated. What the forces know of the past returns with it, and so do the bodies that react.
template <class Attempt>
void take_in_pieces(System& system, Constraints& constraints, State& state, double h, int max_halvings,
                    State& before, StepReport& report, const Attempt& attempt) {
  const double end = state.time + h;
  int halvings = 0, left = 1;
  report.substeps = 0;
  while (left > 0) {
    if (attempt(Piece{std::ldexp(h, -halvings), halvings, halvings == max_halvings})) {
      --left;
      ++report.substeps;
      continue;
    }
    if (halvings == 0) {
      before = state;
      system.keep();
      constraints.keep();
    }
    if (halvings == max_halvings) {
      state = before;
      system.go_back();
      constraints.go_back();
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
