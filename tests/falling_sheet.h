// The system of a real step, for preconditioners and for solvers that keep something.
#pragma once

#include "app/compare/recording_solver.h"
#include "tests/tables.h"

namespace drape::test {

using namespace app;

// A hung sheet after some steps: the matrix of a real fall, slack and taut edges in it.
struct FallingSheet : HungSheet {
  SystemRecording recording;
  ImplicitEuler stepper;
  Filter filter;
  VecX b, guess;

  FallingSheet(int side, int steps, double stretch = 2000)
      : HungSheet(side, stretch, 1e-5),
        stepper(system, constraints, std::make_unique<RecordingSolver>(make_linear_solver("mpcg"), recording),
                {.tolerance = 1e-3}) {
    for (int k = 0; k < steps; ++k) {
      recording.on = k + 1 == steps;
      stepper.advance(state, 0.01);
    }
    b = recording.last->b;
    guess = recording.last->guess;
    filter = held({0, side - 1});
  }

  // Locks some particles, and lets every third one of them slide.
  Filter held(const std::vector<int>& particles) const {
    Filter f;
    int count = 0;
    for (int i : particles) {
      const Vec3 n = Vec3(0.3, 1, -0.2).normalized();
      const Mat3 S = ++count % 3 == 0 ? Mat3(Mat3::Identity() - n * n.transpose()) : Mat3(Mat3::Zero());
      f.constrain(i, S, Vec3::Zero());
    }
    f.renumber(stepper.matrix().pattern().row_of());
    return f;
  }
};

}  // namespace drape::test
