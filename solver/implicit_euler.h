// The implicit step, as the backward difference formula of order 1.       [Baraff & Witkin 1998, eq. 6 and
// 18; Noh & Jung, eq. 16-17]
//   (M + c D + c^2 K) dv = M (v_bar - v) + c (f(x, v) - K y),   y = x_bar + c v - x,   c = h
//   x_bar = x_n + correction,  v_bar = v_n;   then v += dv, x = x_bar + c v
//   This is Newton's iteration for the minimum of the incremental potential
//     Phi(v) = 1/2 |v - v_bar - h g|^2_M + E(x_bar + h v) + h/2 v . D v
//   that starts from standing still (v = -(x_bar - x_n)/h). A full step that would raise Phi is cut short by
//   halves, and iterations go on until a full one is good: so a step makes no energy, however stiff the
//   cloth.    [Nocedal & Wright 2006, section 3.1] K = -df/dx, D = -df/dv at the point of linearisation (x,
//   v): the last state first, the last iterate after.
// x [m], v [m/s], M [kg], f [N], h [s].
#pragma once

#include "solver/integrator.h"

namespace drape {

class ImplicitEuler final : public Integrator {
 public:
  // Keeps references to the system and the constraints.
  ImplicitEuler(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
                const StepOptions& options = {});

  std::string_view name() const override { return "implicit-euler"; }
  // A step that fails (not finite, no convergence) is taken again in halves, at most max_halvings times
  // halved.
  StepReport advance(State& state, double h) override;

  StepOptions& options() { return options_; }
  // The matrix of the last solve, in row order, contact friction included.
  const BlockMatrix& matrix() const { return *A_; }

 private:
  bool attempt(State& state, double h, StepReport& report);
  void resize();
  void assemble(const VecX& v_bar, double h, Stiffness stiffness);
  void guess(double h);
  LinearReport solve_within_contacts(double h, StepReport& report);
  LinearReport solve_once(double h, double tolerance);
  void add_contact_friction(double h);
  void remove_contact_friction();
  double nonlinear_residual(double h);
  double potential(const VecX& v, const VecX& v_bar, double h);
  bool descend(const VecX& v_bar, bool first, double h);
  void reaction();
  bool good(const LinearReport& linear) const;
  bool fail(StepReport& report, const std::string& what, const LinearReport& linear);
  std::string stiffest_force(int particle);

  System& system_;
  Constraints& constraints_;
  std::unique_ptr<LinearSolver> solver_;
  StepOptions options_;

  std::unique_ptr<BlockMatrix> A_;
  Filter filter_;
  VecX x_, v_, x_bar_, y_, x_new_, v_new_, v_base_;  // particle order
  VecX guess_, b_, b_friction_, r_;                  // particle order
  VecX dv_rows_, b_rows_, r_rows_, dv_;              // row order, but dv_
  std::vector<std::pair<int, Mat3>> rubbed_;         // diagonal blocks as they were before contact friction
  double weight_impulse_ = 0;                        // N s, h |m g|
  double fall_energy_ = 0;                           // J, sum of m (h g)^2
};

}  // namespace drape
