// Springs in the first iteration of a substep, four at a time (relax_pair of solver/forces/pair_projection.h,
// written out for vectors of four numbers).
#include "solver/forces/buckling_series.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/linear_spring.h"
#include "solver/forces/tension_spring.h"
#include "solver/matrix/four.h"

namespace drape {
namespace {

using internal::Four;
// The same where memory is aligned: a template does not know of Four that it may not be.
typedef double Aligned __attribute__((vector_size(32)));

template <class Rest>
using FourRests = std::array<const Rest*, 4>;

template <class Rest>
Four of(const FourRests<Rest>& r, double Rest::*number) {
  return Four{r[0]->*number, r[1]->*number, r[2]->*number, r[3]->*number};
}

// t and dt/dl of four springs of the lengths l.

void find_tension(const FourRests<LinearSpring::Rest>& r, const Four& l, Four& t, Four& dt) {
  dt = of(r, &LinearSpring::Rest::k);
  t = dt * (l - of(r, &LinearSpring::Rest::L));
}

void find_tension(const FourRests<TensionSpring::Rest>& r, const Four& l, Four& t, Four& dt) {
  const Four L = of(r, &TensionSpring::Rest::L), k = of(r, &TensionSpring::Rest::k), slack = {};
  dt = l >= L * (1 - 1e-12) ? k : slack;
  t = dt * (l - L);
}

void find_tension(const FourRests<BucklingSpring::Rest>& r, const Four& l, Four& t, Four& dt) {
  using Rest = BucklingSpring::Rest;
  const Four L = of(r, &Rest::L), c_b = of(r, &Rest::c_b), delta = (L - l) / L, none = {};
  dt = delta > none ? c_b : none;
  t = dt * (l - L);
  const auto buckled = delta > of(r, &Rest::crossing);
  if (!(buckled[0] | buckled[1] | buckled[2] | buckled[3])) return;
  const Four k_b = of(r, &Rest::k_b), anything = none + 0.5;
  const Aligned chosen = buckled ? delta : anything;
  Aligned y, force, stiffness;
  internal::find_buckling(chosen, y, force, stiffness);
  t = buckled ? k_b / (L * L) * force : t;
  dt = buckled ? k_b / (L * L * L) * stiffness : dt;
}

template <class Rest>
void relax_four(const StencilLink<2, Rest>* links, Substep& substep, Vec3* impulses) {
  double* const x = substep.x.data();
  std::array<double*, 4> a, b;
  FourRests<Rest> rests;
  Four share_a, share_b;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [i, j] = links[k].particles;
    a[k] = x + 3 * i, b[k] = x + 3 * j;
    share_a[k] = substep.mobility[static_cast<std::size_t>(i)];
    share_b[k] = substep.mobility[static_cast<std::size_t>(j)];
    rests[k] = &links[k].rest;
  }
  Four d[3];
  for (std::size_t c = 0; c < 3; ++c)
    d[c] = Four{a[0][c], a[1][c], a[2][c], a[3][c]} - Four{b[0][c], b[1][c], b[2][c], b[3][c]};
  const Four l = internal::root(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), zero = {};
  const double h = substep.h;
  Four t, k;
  find_tension(rests, l, t, k);
  const Four chord = t / (l - of(rests, &Rest::L));
  k = t < zero ? (k > chord ? k : chord) : k;
  Four s = -(h * t) / ((1 + (share_a + share_b) * (h * h * k)) * l);
  s = l > zero ? s : zero;
  for (std::size_t c = 0; c < 3; ++c) {
    const Four impulse = s * d[c], moved = h * impulse, moved_a = share_a * moved, moved_b = share_b * moved;
    for (std::size_t n = 0; n < 4; ++n) {
      a[n][c] += moved_a[n];
      b[n][c] -= moved_b[n];
    }
    if (impulses)
      for (std::size_t n = 0; n < 4; ++n) impulses[n][static_cast<Eigen::Index>(c)] = impulse[n];
  }
}

template <class Spring>
void relax_all(const StencilLink<2, typename Spring::Rest>* links, int count, Substep& substep,
               Vec3* impulses) {
  int k = 0;
  for (; k + 4 <= count; k += 4) relax_four(links + k, substep, impulses ? impulses + k : nullptr);
  for (; k < count; ++k) {
    Vec3 impulse = Vec3::Zero();
    relax_pair<AlongDistance<Spring>>(0.0, links[k], substep, impulse);
    if (impulses) impulses[k] = impulse;
  }
}

}  // namespace

void LinearSpring::relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep,
                               Vec3* impulses) {
  relax_all<LinearSpring>(links, count, substep, impulses);
}

void TensionSpring::relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep,
                                Vec3* impulses) {
  relax_all<TensionSpring>(links, count, substep, impulses);
}

void BucklingSpring::relax_apart(const StencilLink<2, Rest>* links, int count, Substep& substep,
                                 Vec3* impulses) {
  relax_all<BucklingSpring>(links, count, substep, impulses);
}

}  // namespace drape
