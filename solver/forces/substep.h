// A substep of the integrator "pbd" (solver/integrators/pbd.h), as the forces see it. The particles go from
// `start` to x, and each element of each force changes x in turn, as if it were alone.
//   An element depends on p = sum w_k x_k and has pushed p with the impulse lambda so far. Its new impulse is
//   the one that it ends the substep with when all others stay as they are:
//     lambda' + h (dE/dp + D v_p) = 0   at   p + h W (lambda' - lambda),   W = sum w_k^2 / m_k
//   by one step of Newton's method, which is exact where the element is linear:
//     lambda' - lambda = -(1 + W (h^2 K + h D))^-1 (lambda + h (dE/dp + D v_p)),   x_k += h w_k / m_k (lambda' - lambda)
// Of a strong damper less counts: the trace of h W D is at most the number of iterations of the substep.
// Elements are taken by turns, and one that hardly lets p change would keep what those before it have left
// wrong: woven cloth with a viscosity of 10 ms stretched to twice its length, and gained energy.
//   Of a spring of stiffness k this is equation 18 of [Macklin, Muller & Chentanez 2016] with the compliance
//   1/k; the multiplier there is h times lambda. Repeated until nothing changes, it is the step of implicit
//   Euler.
// Links of a length d may be drawn there without any stiffness, a share alpha of the way:
//     length           p <- p - alpha (l - d) n,                       l = |p|,  n = p / l
//     squared length   p <- p - alpha (l^2 - d^2) / (l^2 + d^2) p      without a square root
//   shared by w_k / m_k, so that momentum is kept.                             [Bullet's soft bodies; Jakobsen 2001]
// lambda [N s], p, l, d [m], E [J], K [N/m], D [N s/m], W [1/kg], h [s].
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

// How a link of a length is drawn to it.
enum class Links { compliance, length, squared_length };

struct LinksInfo {
  Links links;
  std::string_view name, summary;
};
inline constexpr std::array<LinksInfo, 3> link_kinds = {{
    {Links::compliance, "compliance", "by the stiffness of each spring"},
    {Links::length, "length", "the share alpha of what a spring is too long, whatever its stiffness"},
    {Links::squared_length, "squared-length", "the same by squares of lengths"},
}};

struct ProjectionOptions {
  int substeps = 20;   // of a step
  int iterations = 1;  // in a substep: how often every element is taken
  Links links = Links::compliance;
  double alpha = 1;  // share of the way, from 0 to 1, of links that are drawn to a length
};

struct Substep {
  double h;                             // s
  const VecX& start;                    // m
  const std::vector<double>& mobility;  // 1/m_k of each particle [1/kg]; 0: it is held
  VecX& x;                              // m
  const ProjectionOptions& options;
  bool first, last;  // of its iterations; in the first all impulses are zero

  // The share of a damper that counts, of which the trace of h W D is `takes`.
  double counted(double takes) const { return takes > options.iterations ? options.iterations / takes : 1; }
};

}  // namespace drape
