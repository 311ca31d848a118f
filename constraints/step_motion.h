// A step as the constraints see it: where the particles begin, how long it takes, and which are held anyway.
// Internal to the library's constraints.
#pragma once

#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

// How far contacts are looked for when a step begins.
enum class Foresight {
  ahead,  // along the motion x -> x + h v that is foreseen
  here,   // where the particles are: for motions that vibrate within a step
  none,   // contact is answered after the motion, see ContactStep::respond
};

struct StepMotion {
  double t = 0, h = 0;  // s
  double last_h = 0;    // s, of the last completed step
  Foresight foresight = Foresight::ahead;
  double work = 0;             // J, that moving bodies and pins do on the particles
  VecX x, v;                   // at the start [m], [m/s]
  VecX x_end;                  // where the last completed step ended [m]
  std::vector<double> masses;  // kg
  std::vector<char> held;      // of each particle: pinned, or without mass

  bool is_held(int particle) const { return held[particle] != 0; }
  double mass(int particle) const { return masses[particle]; }
  Vec3 place(int particle) const { return x.segment<3>(3 * particle); }
  Vec3 velocity(int particle) const { return v.segment<3>(3 * particle); }
};

}  // namespace drape
