// The backward difference formulas of order 1 and 2 in one step: "implicit-euler" and "bdf2".
//   (M + c D + c^2 K) dv = M (v_bar - v) + c (f(x, v) - K y),   y = x_bar + c v - x,   c = gamma h
//   then v += dv, x = x_bar + c v.    K = -df/dx, D = -df/dv at the point of linearisation (x, v).
//   order 1   gamma = 1                     x_bar = x_n                         [Baraff & Witkin 1998, eq. 6]
//   order 2   gamma = (1 + w) / (1 + 2 w)   x_bar = x_n + w^2 / (1 + 2 w) (x_n - x_{n-1})   [Choi & Ko 2002]
//             w = h_n / h_{n-1}; 2/3 and 1/3 when steps do not change    [Hairer, Norsett & Wanner, III.5]
//   v_bar like x_bar; contact adds its correction to x_bar. [Baraff & Witkin 1998, section 6 and eq. 18]
// Order 1 linearises at the last state. Order 2 at v_n + w (v_n - v_{n-1}), x_bar + c times that: from the
// last state one solve with a K that is not the exact one would be of first order only.
//   This is Newton's iteration for the minimum of the incremental potential
//     Phi(v) = 1/2 |v - v_bar - c g|^2_M + E(x_bar + c v) + c/2 v . D v
//   that starts from standing still (v = 0). A full step that would raise Phi is cut short by halves, and
//   iterations go on until a full one is good: so a step of order 1 makes no energy, however stiff the cloth.
//                                                                [Nocedal & Wright 2006, section 3.1]
//   What may be round-off is neither a rise of Phi nor a residual, see solver/integrators/potential.h.
// Order 2 looks back over smooth motion only. Without a last step (the first one, a state that was changed
// from outside, a failed step taken in halves, h more than doubled) the step is of order 1. A particle that
// touches a body, or did in the last step, takes it with what is known of its present motion u alone:
//   gamma m (v - v_n) = c f,   x = x_n + (h - c) u + c v      (u = v_n, and the target where it is locked)
// A step of order 2 that made energy is taken again by order 1 (and counted in rescues).
// x [m], v [m/s], M [kg], f [N], h [s].
#pragma once

#include <cmath>

#include "solver/integrators/integrator.h"

namespace drape {

// What round-off makes of the incremental potential and of its gradient, see solver/integrators/potential.h.
struct RoundOff {
  double least = 0;    // J, N there
  double impulse = 0;  // N s, of the gradient
  double energy(double phi) const { return least + 2 * std::sqrt(std::abs(phi) * least); }  // J, of Phi = phi
};

struct Piece;  // solver/integrators/pieces.h

class Bdf final : public Integrator {
 public:
  // Keeps references to the system and the constraints. order: 1 or 2.
  Bdf(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
      const StepOptions& options = {}, int order = 1);

  std::string_view name() const override { return order_ == 1 ? "implicit-euler" : "bdf2"; }
  // A step that fails (not finite, no convergence) is taken again in halves, at most max_halvings times
  // halved.
  StepReport advance(State& state, double h) override;

  StepOptions& options() { return options_; }
  // The matrix of the last solve, in row order, contact friction included.
  const BlockMatrix& matrix() const { return *A_; }

 private:
  // The last step that was done, for order 2.
  struct Past {
    VecX x, v;                  // where it began
    VecX x_end, v_end;          // and ended
    double h = 0;               // s; 0: there is none
    std::vector<char> touched;  // particle -> it met a body
  };

  bool attempt(State& state, const Piece& piece, StepReport& report);
  void resize();
  void choose_coefficients(const State& state, double h, bool whole);
  void look_back(const State& state);
  bool makes_energy(const State& state) const;
  void restart_touching(const State& state);
  void linearise(const State& state, Stiffness stiffness, StepReport& report);
  void assemble(Stiffness stiffness);
  void guess();
  LinearReport solve_within_contacts(const State& state, Stiffness stiffness, StepReport& report);
  LinearReport solve_once(double tolerance);
  void add_contact_friction();
  void remove_contact_friction();
  double nonlinear_residual();
  double potential(const VecX& v);
  bool descend(bool first);
  void remember(const State& state, double h);
  void mark_touching();
  bool restarts(int particle) const {
    return back_ > 0 && past_.touched[static_cast<std::size_t>(particle)] != 0;
  }
  // How long gravity acts in a row of the system: c, but for what restarts.
  double fall_time(int particle) const { return restarts(particle) ? h_ : c_; }
  // What a row is multiplied with: an impulse J of the world stands there as row_scale J.
  double row_scale(int particle) const { return restarts(particle) ? c_ / h_ : 1; }
  const std::vector<ContactFriction>& friction();
  void reaction();
  bool good(const LinearReport& linear) const;
  bool fail(StepReport& report, const std::string& what, const LinearReport& linear);
  std::string stiffest_force(int particle);

  System& system_;
  Constraints& constraints_;
  std::unique_ptr<LinearSolver> solver_;
  StepOptions options_;
  int order_;

  // The step under way.
  double h_ = 0, c_ = 0;  // s, c = gamma h
  double back_ = 0;       // x_bar = x_n + back (x_n - x_{n-1}); 0: order 1
  double ahead_ = 0;      // w above
  State before_;
  Past past_;

  std::unique_ptr<BlockMatrix> A_;
  Filter filter_;
  std::vector<double> mass_;                                 // kg, times gamma where a particle restarts
  VecX x_, v_, x_bar_, v_bar_, y_, x_new_, v_new_, v_base_;  // particle order
  VecX guess_, b_, b_friction_, r_;                          // particle order
  VecX dv_rows_, b_rows_, r_rows_, dv_;                      // row order, but dv_
  std::vector<ContactFriction> friction_;                    // as it stands in the rows
  std::vector<std::pair<int, Mat3>> rubbed_;  // diagonal blocks as they were before contact friction
  double weight_impulse_ = 0;                 // N s, h |m g|
  double fall_energy_ = 0;                    // J, sum of m (h g)^2
  RoundOff noise_;                            // where it was linearised last
};

// The step of Baraff & Witkin, order 1.
using ImplicitEuler = Bdf;

}  // namespace drape
