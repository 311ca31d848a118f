// How long a step an integrator bears in a scene: runs of the same time at steps that are bisected.
//   stable  every step was done, all numbers are finite, and no energy was made:
//     rise = (E - W) - E_0  <=  growth * given,    E = kinetic + elastic + gravity energy, at every step
//     given = kinetic_0 + elastic_0 + the deepest fall of the gravity energy + what W added + m (h g)^2
//     W: the work of bodies and pins that move. What contact, friction and damping take makes it fall.
//   Methods of first order err by a part of h / T in a free fall, and symplectic Euler's energy swings: so
//   growth is 1 unless it is given, not 0. What is unstable exceeds it by orders of magnitude, and soon.
// x [m], v [m/s], E [J], h and T [s].
#pragma once

#include <optional>

#include "app/scene/scene.h"
#include "solver/stability/stability.h"

namespace drape {

struct StabilityOptions {
  double time = 1;          // s, of every run
  double shake = 1e-3;      // m/s: every particle starts with up to so much more, along x, y and z, at random
  double growth = 1;        // see above
  double precision = 0.01;  // of the largest stable step
  double longest = 0.1;     // s, no step is tried beyond
  double shortest = 1e-5;   // s, nor below
  std::vector<std::string> integrators;  // all with a step of their own
};

struct StabilityRow {
  std::string integrator, contact;
  std::optional<double> largest;  // s; none: not even the shortest was stable
  bool limited = false;           // a longer one was tried and was not
  std::string failure;            // what the shortest unstable run did
  std::optional<double> theory;   // s, of an explicit method; 0: no step is short enough; infinite: no limit
  long steps_cut = 0;             // of the run at the largest: taken in pieces
  int runs = 0;
};

// The scene at its start, as theory sees it.
Spectrum spectrum_of(const Scene& scene);

// Empty when the user interrupts. Throws InputError where the scene or the name is wrong.
std::optional<StabilityRow> largest_stable_step(const Scene& scene, const std::string& integrator,
                                                const StabilityOptions& options, const Spectrum& spectrum);

}  // namespace drape
