// What all linear solvers share: the residual outside the iteration, and the impulse that it is compared
// with.
#pragma once

#include <cmath>

#include "mesh/base/parallel.h"
#include "solver/linear/linear_solver.h"

namespace drape::internal {

// r <- b - A dv
inline void left_over(const BlockMatrix& A, const VecX& b, const VecX& dv, VecX& r) {
  A.multiply(dv, r);
  for_chunks(A.rows(), [&](int begin, int end) {
    for (int i = 3 * begin; i < 3 * end; ++i) r[i] = b[i] - r[i];
  });
}

// r <- S (b - A dv)
inline void residual(const BlockMatrix& A, const VecX& b, const Filter& filter, const VecX& dv, VecX& r) {
  left_over(A, b, dv, r);
  filter.apply(r);
}

inline int iteration_limit(const LinearOptions& options, int rows) {
  if (options.max_iterations > 0) return options.max_iterations;
  return 1000 + static_cast<int>(20 * std::sqrt(static_cast<double>(rows)));
}

// The norm |S (b - A z)| [N s] of the right-hand side of the projected system, or options.scale where that is
// larger, but at most options.most_scale; and no less than lets the tolerance be reached, since no residual
// comes below the round-off of what the projection takes out. Fills z, and leaves S (b - A z) in r. Where all
// that acts is along what is locked, the projection leaves its round-off, which no iteration can lessen: that
// counts as zero.
inline double reference_impulse(const BlockMatrix& A, const VecX& b, const Filter& filter,
                                const LinearOptions& options, VecX& z, VecX& r) {
  constexpr double round_off = 2e-15;
  z.setZero();
  bool moving = false;
  for (const FilterEntry& e : filter.entries()) {
    z.segment<3>(3 * e.particle) = e.z;
    moving = moving || !e.z.isZero(0);
  }
  if (moving)
    left_over(A, b, z, r);
  else
    r = b;
  const double whole = std::sqrt(dot(b, b)) + std::sqrt(dot(r, r));
  filter.apply(r);
  const double acting = std::sqrt(dot(r, r));
  if (std::isfinite(whole) && acting < round_off * whole) {
    r.setZero();
    return 0;
  }
  const double least = options.tolerance > 0 ? round_off * whole / options.tolerance : 0;
  return std::max(std::min(std::max(acting, options.scale), options.most_scale), least);
}

// The multiple of the guess at which y . S A S y / 2 - y . r, with r = S (b - A z), is least along it. Free
// fall, say, is right where nothing holds, and as wrong as can be where all lies still. Takes what is locked
// out of dv, and leaves S A dv in q.
inline double best_multiple(const BlockMatrix& A, const Filter& filter, const VecX& r, VecX& dv, VecX& q) {
  constexpr double round_off = 1e-10;
  const double whole = dot(dv, dv);
  filter.apply(dv);
  q.resize(dv.size());
  A.multiply(dv, q);
  filter.apply(q);
  if (dot(dv, dv) < round_off * round_off * whole) return 0;  // all of it was locked
  const double curvature = dot(dv, q), multiple = dot(dv, r) / curvature;
  return curvature > 0 && std::isfinite(multiple) ? multiple : 1;
}

// Completes the report of a solver that has no residual of its own. dv meets the constraints to the last bit,
// and is z where no impulse acts.
inline void finish(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                   double reference, VecX& dv, VecX& scratch, LinearReport& report) {
  scratch.resize(dv.size());
  if (reference == 0) dv.setZero();
  filter.impose(dv);
  residual(A, b, filter, dv, scratch);
  report.residual_impulse = std::sqrt(dot(scratch, scratch));
  report.residual = reference == 0 ? 0 : report.residual_impulse / reference;
  if (!std::isfinite(report.residual))
    report.reason = StopReason::not_finite;
  else if (report.residual > std::max(1.01 * options.tolerance, 1e-12))
    report.reason = StopReason::iteration_limit;
}

}  // namespace drape::internal
