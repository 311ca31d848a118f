// Finds the longest time step at which an integrator is stable in a scene. Runs of equal duration are made
// with steps that are bisected.
//   stable  every step was done, all numbers are finite, and no energy was made. That is, after every step
//     rise = (E - W) - E_0  <=  growth * given,    E = kinetic + elastic + gravity energy
//     given = kinetic_0 + elastic_0 + the deepest fall of the gravity energy + what W added + m (h g)^2
//     W: the work of moving bodies and pins. Contact, friction and damping only take energy, so that E falls.
//   Methods of first order have an error of a fraction of h / T in a free fall, and the energy of symplectic
//   Euler swings. Therefore growth is 1 unless it is given, not 0. An unstable run exceeds it by orders of
//   magnitude, and soon.
#pragma once

#include <optional>

#include "app/scene/scene.h"
#include "solver/stability/stability.h"

namespace drape::app {

struct StabilityOptions {
  double time = 1;  // s, duration of every run
  // m/s. Every particle starts with a random extra velocity, up to this much along each of x, y and z.
  double shake = 1e-3;
  double growth = 1;                     // see above
  double precision = 0.01;               // relative precision of the largest stable step
  double longest = 0.1;                  // s; no longer step is tried
  double shortest = 1e-5;                // s; no shorter step is tried
  std::vector<std::string> integrators;  // all those that have a step of their own
};

struct StabilityRow {
  std::string integrator, contact;
  std::optional<double> largest;  // s; empty when not even the shortest step was stable
  bool limited = false;           // true when a longer step was tried and was not stable
  std::string failure;            // what went wrong in the shortest unstable run
  // The limit in theory [s], for an explicit method. 0: no step is short enough; infinite: there is no limit.
  std::optional<double> theory;
  long steps_cut = 0;  // number of steps of the run at `largest` that were cut into pieces
  int runs = 0;
};

// The stiffest modes of the scene at its start, for the limits in theory.
Spectrum spectrum_of(const Scene& scene);

// Empty when the user interrupts. Throws InputError when the scene or the name of the integrator is wrong.
std::optional<StabilityRow> largest_stable_step(const Scene& scene, const std::string& integrator,
                                                const StabilityOptions& options, const Spectrum& spectrum);

}  // namespace drape::app
