// What an implicit step minimises, and how far a Newton step may go.
//   Phi(v) = 1/2 |v - v_bar - c g|^2_M + E(x_bar + c v) + c/2 v . D v + what friction of contacts takes in h
// with D where the step was linearised last, as the matrix has it: it may turn with the motion.
// The first Newton step is judged against a cloth at rest (solver/integrators/rest_frame.h; v = 0 where its
// pins and bodies stand, and what is prescribed), each later one against the v before it, unless that has come
// to be above rest. A full step that would raise Phi is cut short by halves.
//                                                                  [Nocedal & Wright 2006, section 3.1]
// So a step of order 1 does not raise Phi, however stiff the cloth. The energy that it makes all the same,
// because one linear solve does not find the least Phi, is what makes_energy() is for.
// Where edges go slack, the first Newton step may be taken whole although it raises Phi: the next one knows
// which edges have become taut, and is judged against a cloth at rest in its place.
//                                                                  [the watchdog of Chamberlain et al. 1982]
// Rounding of x and v, in sums of a few terms, disturbs v by e_i = 8 eps (|x_i|/c + |v_i|). With
//   N = sum A_ii e_i^2
// it changes Phi, a sum of squares, by at most N + 2 sqrt(Phi N), and the gradient of Phi by |A_ii e_i|. Forces
// whose energy is a sum of terms that cancel add what these may be off (Force::energy_noise). Without gravity
// there is no other scale of what is small. A change that may be round-off counts neither as a rise of Phi nor
// as a residual.
// x [m], v [m/s], A [kg], c, h [s].
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "solver/integrators/step_history.h"

namespace drape {

// How much round-off may change Phi and its gradient.
struct RoundOff {
  double least = 0;                  // N above [J]
  double impulse = 0;                // of the gradient [N s]
  double terms = 0;                  // of energies that are sums of terms that cancel [J]
  double energy(double phi) const {  // of Phi [J]
    return least + 2 * std::sqrt(std::abs(phi) * least) + terms;
  }
};
RoundOff round_off(const System& system, const BlockMatrix& A, const VecX& x, const VecX& v, double c);

// 1/2 v . D v [W], with D at the point damped_at.
double dissipation_of_forces(const System& system, const VecX& damped_at, const VecX& v);

// How much energy a motion may make and count as making none, as shares of the energy m (h g)^2 of the fall
// of a step and of the kinetic energy of the motion.
struct EnergyAllowance {
  double of_fall, of_motion;
  bool of_contacts;  // whether what contacts store counts as energy of the cloth
};

// How far a Newton step was taken: whole, whole although Phi rose, or cut short.
enum class StepTaken { whole, overshot, cut };

class Merit {
 public:
  explicit Merit(const System& system) : system_(system) {}

  void begin(double h);  // begins a step of h [s]
  void measure(const BlockMatrix& A, const Point& p,
               double c);  // a step was linearised at p: measures the round-off there
  double weight_impulse() const { return weight_impulse_; }  // h |m g| [N s]
  // The change of a particle's velocity that a residual of this norm [N s] makes, if it is spread evenly; at
  // most a fiftieth of what gravity changes it by, so that a coarse solve decides contacts, too [m/s].
  double speed_noise(double residual) const;
  double noise_impulse() const { return noise_.impulse; }  // round-off of a residual [N s]

  double potential(const StepCoefficients& k, const std::vector<ContactFriction>& friction, const VecX& v);
  // True when Phi at v is not above its value at v_base, but for what solves and round-off change.
  bool falls(const StepCoefficients& k, const std::vector<ContactFriction>& friction, const VecX& v_base,
             const VecX& v);
  // v <- v + dv where that does not raise Phi above its value at v_base, or where it may overshoot; otherwise
  // v goes back towards v_base by halves until Phi is not above that value.
  StepTaken descend(const StepCoefficients& k, const std::vector<ContactFriction>& friction,
                    const VecX& v_base, const VecX& dv, bool may_overshoot, VecX& v);
  // True when the motion has more energy than moving bodies, pins and the wind gave it (`given`), and than is
  // allowed: one of order 2 has then looked back across a contact or a slackening of stiff cloth, and one of
  // order 1 has bent or turned further in a step than its linearisation knows. How fast it is counts against a
  // cloth at rest, which moves by `rest` [m/s].
  bool makes_energy(const StepCoefficients& k, const State& before, const Point& after, const VecX& rest,
                    double given, const EnergyAllowance& allowed);

 private:
  double most(double start) const;
  double elastic_energy(const VecX& x);  // J

  const System& system_;
  double mass_ = 0;            // the norm of all masses [kg]
  double weight_impulse_ = 0;  // h |m g| [N s]
  double fall_energy_ = 0;     // sum of m (h g)^2 [J]
  RoundOff noise_;             // at the point where it was measured last
  VecX linearised_at_;         // x there [m]
  VecX x_;                     // scratch
  // The elastic energy is asked for at a point more than once: where a step begins, and where it ends.
  struct Measured {
    VecX x;             // m
    double energy = 0;  // J
    bool known = false;
  };
  std::array<Measured, 2> measured_;
};

}  // namespace drape
