// What an implicit step minimises, and how far a Newton step may go.
//   Phi(v) = 1/2 |v - v_bar - c g|^2_M + E(x_bar + c v) + c/2 v . D v + what friction of contacts takes in h
// Newton's iteration starts from standing still (v = 0), but for what is prescribed. A full step that would
// raise Phi is cut short by halves: so a step of order 1 makes no energy, however stiff the cloth.
//                                                                [Nocedal & Wright 2006, section 3.1]
// Rounding of x and v, in sums of a few terms, is a disturbance e_i = 8 eps (|x_i|/c + |v_i|) of v, and that
// is at most   N = sum A_ii e_i^2, and N + 2 sqrt(Phi N) of Phi, a sum of squares;   |A_ii e_i| of its
// gradient. Without gravity, nothing else tells what is small. What may be round-off is neither a rise of Phi
// nor a residual.
// x [m], v [m/s], A [kg], c, h [s].
#pragma once

#include <cmath>
#include <vector>

#include "solver/integrators/step_history.h"

namespace drape {

// What round-off makes of Phi and of its gradient.
struct RoundOff {
  double least = 0;    // J, N there
  double impulse = 0;  // N s, of the gradient
  double energy(double phi) const { return least + 2 * std::sqrt(std::abs(phi) * least); }  // J, of Phi = phi
};
RoundOff round_off(const BlockMatrix& A, const VecX& x, const VecX& v, double c);

// E(x) + c/2 v . D v + what friction of contacts takes in h [J].
double potential_of_forces(const System& system, const std::vector<ContactFriction>& friction, const VecX& x,
                           const VecX& v, double c, double h);

class Merit {
 public:
  explicit Merit(const System& system) : system_(system) {}

  void begin(double h);                                          // a step of h
  void measure(const BlockMatrix& A, const Point& p, double c);  // the round-off there
  double weight_impulse() const { return weight_impulse_; }      // N s, h |m g|
  double noise_impulse() const { return noise_.impulse; }        // N s, a residual that may be round-off

  double potential(const StepCoefficients& k, const std::vector<ContactFriction>& friction, const VecX& v);
  // v <- v + dv when that lowers Phi below its value at v_base, else as far back towards v_base as does. True
  // when the step was taken whole.
  bool descend(const StepCoefficients& k, const std::vector<ContactFriction>& friction, const VecX& v_base,
               const VecX& dv, VecX& v);
  // The motion has more energy than moving bodies bring and than the error of a smooth motion explains: a step
  // of order 2 has looked back across a contact or a slackening of stiff cloth.
  bool makes_energy(const State& before, const Point& after, double work) const;

 private:
  const System& system_;
  double weight_impulse_ = 0;  // N s
  double fall_energy_ = 0;     // J, sum of m (h g)^2
  RoundOff noise_;             // where it was measured last
  VecX x_;                     // scratch
};

}  // namespace drape
