#include "solver/linear/mpcg.h"

#include <Eigen/LU>
#include <atomic>

#include "solver/linear/residual.h"

namespace drape {

void Mpcg::resize(Eigen::Index n) {
  if (r_.size() == n) return;
  for (VecX* vector : {&r_, &d_, &q_, &s_}) vector->resize(n);
  inverse_.resize(static_cast<std::size_t>(2 * n));
}

// The 3x3 diagonal blocks of S A S + I - S, inverted: the preconditioner knows the constraints. False when
// one of them is not positive definite, and so A neither.
bool Mpcg::invert_diagonal(const BlockMatrix& A, const Filter& filter) {
  std::atomic<bool> definite{true};
  const auto store = [&](int row, const Mat3& block) {
    const Mat3 inverse = block.inverse();
    const double minor = block(0, 0) * block(1, 1) - block(0, 1) * block(1, 0);
    if (block(0, 0) <= 0 || minor <= 0 || inverse.diagonal().minCoeff() <= 0) definite = false;
    double* p = inverse_.data() + 6 * static_cast<std::size_t>(row);
    p[0] = inverse(0, 0), p[1] = inverse(1, 1), p[2] = inverse(2, 2);
    p[3] = inverse(1, 0), p[4] = inverse(2, 0), p[5] = inverse(2, 1);
  };
  for_chunks(A.rows(), [&](int begin, int end) {
    for (int r = begin; r < end; ++r) store(r, A.at(A.pattern().diagonal(r)));
  });
  for (const FilterEntry& e : filter.entries())
    store(e.particle, e.S * A.at(A.pattern().diagonal(e.particle)) * e.S + Mat3::Identity() - e.S);
  return definite;
}

LinearReport Mpcg::solve(const BlockMatrix& A, const VecX& b, const Filter& filter,
                         const LinearOptions& options, VecX& dv) {
  resize(b.size());
  const int rows = A.rows();
  LinearReport report;
  if (!invert_diagonal(A, filter)) report.reason = StopReason::indefinite;
  // s = P r, and r.s
  const auto precondition = [&] {
    return sum_chunks(rows, [&](int begin, int end) {
      double sum = 0;
      for (int i = begin; i < end; ++i) {
        const double* p = inverse_.data() + 6 * static_cast<std::size_t>(i);
        const double* r = r_.data() + 3 * static_cast<std::ptrdiff_t>(i);
        double* s = s_.data() + 3 * static_cast<std::ptrdiff_t>(i);
        s[0] = p[0] * r[0] + p[3] * r[1] + p[4] * r[2];
        s[1] = p[3] * r[0] + p[1] * r[1] + p[5] * r[2];
        s[2] = p[4] * r[0] + p[5] * r[1] + p[2] * r[2];
        sum += r[0] * s[0] + r[1] * s[1] + r[2] * s[2];
      }
      return sum;
    });
  };

  const double reference = reference_impulse(A, b, filter, options, d_, r_);
  const int limit = iteration_limit(options, rows);
  filter.impose(dv);
  residual(A, b, filter, dv, r_);
  double rr = dot(r_, r_);
  const double target = options.tolerance * reference;
  int restarts = 0;
  while (report.reason == StopReason::converged) {
    d_.setZero();
    double rho = 1, beta = 0;
    while (rr > target * target && report.iterations < limit) {
      const double rho_new = precondition();
      beta = rho_new / rho;
      rho = rho_new;
      for_chunks(rows, [&](int begin, int end) {
        double* d = d_.data();
        const double* s = s_.data();
        for (int i = 3 * begin; i < 3 * end; ++i) d[i] = s[i] + beta * d[i];
      });
      A.multiply(d_, q_);
      filter.apply(q_);
      const double curvature = dot(d_, q_);
      if (!(curvature > 0)) {
        report.reason = std::isfinite(curvature) ? StopReason::indefinite : StopReason::not_finite;
        break;
      }
      const double alpha = rho / curvature;
      rr = sum_chunks(rows, [&](int begin, int end) {
        double *x = dv.data(), *r = r_.data();
        const double *d = d_.data(), *q = q_.data();
        for (int i = 3 * begin; i < 3 * end; ++i) {
          x[i] += alpha * d[i];
          r[i] -= alpha * q[i];
        }
        return dot_in_order(r + 3 * begin, r + 3 * begin, 3 * (end - begin));
      });
      ++report.iterations;
    }
    if (report.reason != StopReason::converged || !std::isfinite(rr)) break;
    // The recurrence drifts from the true residual by round-off: go on from the true one when that matters.
    residual(A, b, filter, dv, r_);
    rr = dot(r_, r_);
    if (rr <= 1.02 * target * target || report.iterations >= limit || ++restarts > 3) break;
  }
  filter.impose(dv);  // to the last bit
  residual(A, b, filter, dv, r_);
  report.residual_impulse = std::sqrt(dot(r_, r_));
  report.residual = reference > 0 ? report.residual_impulse / reference : 0;
  if (!std::isfinite(report.residual_impulse)) report.reason = StopReason::not_finite;
  if (report.reason == StopReason::converged && report.residual_impulse > 1.01 * target)
    report.reason = StopReason::iteration_limit;
  return report;
}

}  // namespace drape
