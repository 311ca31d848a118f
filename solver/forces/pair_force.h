// Forces between two particles along the line that joins them.
//
// A spring is a pure function of the distance l, given the rest data of one pair:
//   struct Spring { struct Rest {...}; static constexpr const char* name;
//     static double energy(const Rest&, double l);      // E(l)                                        [J]
//     static Tension tension(const Rest&, double l);    // t = dE/dl [N], dt/dl [N/m]
//     static double chord(const Rest&, double l);       // stiffer where a step would overshoot, else 0 [N/m]
//     static double stiffest(const Rest&, double l);    // >= dt/dl: of a parabola above E(l)          [N/m]
//     static constexpr bool link_pushes;                // of a link of the length Rest::L only: whether it pushes, too
//     static bool goes_slack(const Rest&);              // may be left out: whether it resists nothing until it is taut
//     static double damper(double k_d, const Rest&);    // may be left out: the damping of one pair  [N s/m]
//     static void relax_apart(...);                     // may be left out: solver/forces/pair_projection.h
//   };
// With d = x_i - x_j, l = |d|, n = d/l:
//   f_i = -t n - k_d ((v_i - v_j) . n) n,   f_j = -f_i
//   K   = max(dt/dl, 0) n n^T + max(t/l, 0) (I - n n^T)     of block (i,i) and (j,j); -K of (i,j)
// The two eigenvalues of the exact stiffness are dt/dl and t/l (twice). So clamping them at zero gives the
// positive semidefinite part exactly. It drops the transverse term under compression, as Choi & Ko 2002 do.
// Coincident particles have no direction and so no force; K = dt/dl I when t = 0 there (a weld), else 0.
// k_d [N s/m] is the damping along every pair, or what a spring's damper() makes of the number of the force.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/forces/stencil_force.h"

namespace drape {

struct Tension {
  double t;   // N, positive: it pulls the particles together
  double dt;  // N/m
};

template <class Spring>
concept LinkOfLength = requires {
  Spring::link_pushes;
};

template <class Spring>
struct AlongDistance {
  static constexpr const char* name = Spring::name;
  static constexpr int particles = 2;
  using Rest = typename Spring::Rest;
  using Common = double;  // k_d

  static constexpr std::array<double, 2> weights(const Rest&) { return {1, -1}; }

  static double energy(double, const Rest& r, const Vec3& d) { return Spring::energy(r, d.norm()); }

  static bool goes_slack(const Rest& r) {
    if constexpr (requires { Spring::goes_slack(r); })
      return Spring::goes_slack(r);
    else
      return false;
  }

  static double damper(double k_d, const Rest& r) {
    if constexpr (requires { Spring::damper(k_d, r); })
      return Spring::damper(k_d, r);
    else
      return k_d;
  }

  static double dissipation(double damping, const Rest& r, const Vec3& d, const auto& velocity) {
    const double l2 = d.squaredNorm(), k_d = damper(damping, r);
    if (k_d == 0 || l2 == 0) return 0;
    const double along = d.dot(velocity());
    return 0.5 * k_d * along * along / l2;
  }

  static Vec3 pull(double damping, const Rest& r, const Vec3& d, const auto& velocity) {
    const double l = d.norm();
    if (l == 0) return Vec3::Zero();
    const double k_d = damper(damping, r);
    double t = Spring::tension(r, l).t;
    if (k_d > 0) t += k_d / l * d.dot(velocity());
    return t / l * d;
  }

  static VectorResponse linearised(double damping, const Rest& r, const Vec3& d, const auto& velocity,
                                   const auto& shift, double c, Stiffness stiffness) {
    const double l = d.norm();
    Tension law = Spring::tension(r, l);
    if (stiffness == Stiffness::chord) law.dt = std::max(law.dt, Spring::chord(r, l));
    if (stiffness == Stiffness::majorant) law.dt = std::max(law.dt, Spring::stiffest(r, l));
    const double k_d = l == 0 ? 0 : damper(damping, r);
    if ((law.t == 0 && law.dt == 0 && k_d == 0) || (l == 0 && law.t != 0)) return {};
    const double pull = l == 0 ? 0 : law.t / l;
    const double across = l == 0 ? law.dt : std::max(pull, 0.0);
    const double along = std::max(law.dt, 0.0);
    const Vec3 n = l == 0 ? Vec3::Zero() : Vec3(d / l);
    const Vec3 s = shift();
    VectorResponse response{.acts = true};
    response.impulse = c * (pull * d + (along - across) * n.dot(s) * n + across * s);
    if (k_d > 0) response.impulse += c * k_d * n.dot(velocity()) * n;
    response.block = (c * c * (along - across) + c * k_d) * (n * n.transpose()).eval();
    response.block.diagonal().array() += c * c * across;
    return response;
  }

  // For a pair whose distance is l, and would be l_free without its own impulse: the impulse when it acts
  // alone, along the way it would lie, is this times that way [kg/s]. The new distance is found by one step
  // of Newton's method from l (solver/forces/substep.h), with the chord to the rest length where the pair
  // pushes. drag: the speed at which l grows [m/s].
  [[gnu::always_inline]] static double alone_along(double k_d, const Rest& r, double l, double l_free,
                                                   double drag, double W, double h) {
    Tension law = Spring::tension(r, l);
    if (law.dt == 0 && l != l_free) {  // slack by its own pull only
      drag += (l_free - l) / h;
      law = Spring::tension(r, l = l_free);
    }
    if (law.t == 0 && law.dt == 0 && k_d == 0) return 0;
    const double k = law.t < 0 ? std::max(law.dt, law.t / (l - r.L)) : law.dt;
    const double block = h * h * k + h * k_d;
    return -(h * (law.t + k_d * drag) + block * (l_free - l) / h) / ((1 + W * block) * l_free);
  }

  static void relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep,
                          Vec3* impulses) requires requires {
    &Spring::relax_apart;
  }
  { Spring::relax_apart(links, count, substep, impulses); }

  // By which share a link of the squared length l2 is too long; 0 of one that is slack and does not push.
  static double too_long(const Rest& r, double l2, bool squared) requires LinkOfLength<Spring> {
    const double L2 = r.L * r.L;
    if (!Spring::link_pushes && l2 <= L2) return 0;
    return squared ? (l2 - L2) / (l2 + L2) : 1 - r.L / std::sqrt(l2);
  }
};

template <class Spring>
using PairForce = StencilForce<AlongDistance<Spring>>;

}  // namespace drape
