// A step as the constraints see it: where the particles begin, how long it takes, and which particles are
// held in any case.
// Internal to the library's constraints.
#pragma once

#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

// How far contacts are looked for when a step begins.
enum class Foresight {
  ahead,  // along the predicted motion x -> x + h v
  here,   // where the particles are: for motions that vibrate within a step
  none,   // nowhere: contact is answered after the motion, see ContactStep::respond
};

struct StepMotion {
  double t = 0, h = 0;  // s
  double last_h = 0;    // length of the last completed step [s]
  Foresight foresight = Foresight::ahead;
  double work = 0;  // work of moving bodies and pins on the particles [J]
  // At the start [m], [m/s]. Where methods look ahead, the v of what is led is that with which it is led in
  // this step.
  VecX x, v;
  VecX x_end;                   // where the last completed step ended [m]
  std::vector<double> masses;   // kg
  std::vector<double> inertia;  // kg, see ContactStep::set_inertia
  std::vector<char> held;       // per particle: it is pinned, or it has no mass
  std::vector<double> radius;   // m, see Constraints::set_radius; particles beyond its end have none

  bool is_held(int particle) const { return held[particle] != 0; }
  double mass(int particle) const { return masses[particle]; }
  double radius_of(int particle) const {
    return static_cast<std::size_t>(particle) < radius.size() ? radius[particle] : 0;
  }
  Vec3 place(int particle) const { return x.segment<3>(3 * particle); }
  Vec3 velocity(int particle) const { return v.segment<3>(3 * particle); }
};

}  // namespace drape
