// Two particles along their distance, in a substep of the integrator "pbd": the equations are those of
// solver/forces/substep.h. Most elements of a cloth are of this kind, so it is written out, and where it can
// be four of them are taken at once.
//   A law gives
//     static double damper(const Common&, const Rest&);                              // k_d [N s/m]
//     static double alone_along(double k_d, const Rest&, double l, double l_free, double drag, double W,
//     double h);
//   as solver/forces/pair_force.h explains; where it is a link of a length
//     static double too_long(const Rest&, double l2, bool squared);
//   and to take many of them at once, which are to be undamped and to have no particle in common, in their
//   first iteration,
//     static void relax_apart(const StencilLink<2, Rest>* links, int count, Substep&, Vec3* impulses);
//   with the same result as relax_pair to the last bit; impulses: `count` of them to write, or null.
#pragma once

#include <array>
#include <cmath>

#include "solver/forces/substep.h"

namespace drape {

template <int n, class Rest>
struct StencilLink {
  std::array<int, static_cast<std::size_t>(n)> particles;
  Rest rest;
};

template <class Law>
[[gnu::always_inline]] inline void relax_pair(const typename Law::Common& damping,
                                              const StencilLink<2, typename Law::Rest>& link,
                                              Substep& substep, Vec3& lambda) {
  const int i = link.particles[0], j = link.particles[1];
  const typename Law::Rest& rest = link.rest;
  const double share_i = substep.mobility[static_cast<std::size_t>(i)],
               share_j = substep.mobility[static_cast<std::size_t>(j)], W = share_i + share_j, h = substep.h;
  if (W == 0) return;
  double *const a = substep.x.data() + 3 * i, *const b = substep.x.data() + 3 * j;
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  const auto move = [&](double x, double y, double z) {
    a[0] += share_i * x, a[1] += share_i * y, a[2] += share_i * z;
    b[0] -= share_j * x, b[1] -= share_j * y, b[2] -= share_j * z;
  };
  const double l2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  if constexpr (requires { Law::too_long(rest, l2, true); })
    if (const Links links = substep.options.links; links != Links::compliance) {
      const double s =
          l2 > 0 ? -substep.options.alpha / W * Law::too_long(rest, l2, links == Links::squared_length) : 0;
      return move(s * d[0], s * d[1], s * d[2]);
    }
  const double k_d = Law::damper(damping, rest);
  double drag = 0;
  if (k_d > 0 && l2 > 0) {
    const double *const x = substep.start.data() + 3 * i, *const y = substep.start.data() + 3 * j;
    for (int c = 0; c < 3; ++c) drag += d[c] * (d[c] - (x[c] - y[c]));
    drag /= h * std::sqrt(l2);
  }
  if (substep.first) {
    const double l = std::sqrt(l2), s = l > 0 ? Law::alone_along(k_d, rest, l, l, drag, W, h) : 0;
    lambda = Vec3(s * d[0], s * d[1], s * d[2]);
    return move(h * lambda[0], h * lambda[1], h * lambda[2]);
  }
  const double back = h * W;
  const double free[3] = {d[0] - back * lambda[0], d[1] - back * lambda[1], d[2] - back * lambda[2]};
  const double l_free = std::sqrt(free[0] * free[0] + free[1] * free[1] + free[2] * free[2]);
  if (l_free == 0) return;
  const double l = std::max((free[0] * d[0] + free[1] * d[1] + free[2] * d[2]) / l_free, 0.0);
  const double s = Law::alone_along(k_d, rest, l, l_free, drag, W, h);
  const double change[3] = {s * free[0] - lambda[0], s * free[1] - lambda[1], s * free[2] - lambda[2]};
  lambda = Vec3(s * free[0], s * free[1], s * free[2]);
  move(h * change[0], h * change[1], h * change[2]);
}

}  // namespace drape
