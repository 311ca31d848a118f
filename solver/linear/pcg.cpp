// The preconditioned conjugate gradient within a filter, in two variants:
//   mpcg  Baraff & Witkin's modified CG. The unknown is dv itself; residual and search directions are
//         filtered. It starts from dv_0 = a S guess + z, a as in residual.h, and has the symmetric
//         convergence test of Ascher & Boxerman.
//                                              [Baraff & Witkin 1998, 5.3; Ascher & Boxerman 2003]
//   ppcg  plain CG on the prefiltered system (S A S + I - S) y = S (b - A z), dv = y + z, y_0 = a S guess. It
//         takes any preconditioner that was built for the projected matrix.
//                                                              [Tamstorf, Jones & McCormick 2015]
// In exact arithmetic both take the same steps. So the loop stands here once; the variants differ in what
// they start from and in what is added at the end.
#include "solver/linear/pcg.h"

#include <cmath>

#include "mesh/base/stopwatch.h"
#include "solver/linear/residual.h"

namespace drape::internal {
namespace {

class Pcg final : public LinearSolver {
 public:
  Pcg(std::string name, bool prefiltered, std::unique_ptr<Preconditioner> preconditioner)
      : name_(std::move(name)), prefiltered_(prefiltered), preconditioner_(std::move(preconditioner)) {}

  std::string_view name() const override { return name_; }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report;
    resize(b.size());
    prepare(A, filter, report);
    {
      const Stopwatch watch(report.solve_ms);
      const double reference = reference_impulse(A, b, filter, options, z_, r_);  // leaves S (b - A z) in r
      const double multiple = best_multiple(A, filter, r_, dv, q_);
      dv *= multiple;
      if (prefiltered_)
        right_ = r_;
      else
        dv += z_;
      r_ -= multiple * q_;
      const bool known =
          reference != 0 && iterate(A, prefiltered_ ? right_ : b, filter, options, reference, dv, report);
      if (prefiltered_) dv += z_;
      filter.impose(dv);  // meets the constraints to the last bit
      if (!known) {
        if (reference == 0) dv = z_;  // no impulse acts, so there is nothing to do
        residual(A, b, filter, dv, r_);
      }
      conclude(options, reference, report);
    }
    return report;
  }

 private:
  void resize(Eigen::Index n) {
    for (VecX* vector : {&r_, &d_, &q_, &s_, &As_, &z_}) vector->resize(n);
    if (prefiltered_) right_.resize(n);
  }

  void prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) {
    const Stopwatch watch(report.setup_ms);
    if (!preconditioner_->prepare(A, filter, report)) report.reason = StopReason::indefinite;
  }

  // Solves S (right - A x) = 0 in the free directions, starting from x, where r is the residual. Returns
  // whether r is the residual of x in the end, too, computed anew.
  bool iterate(const BlockMatrix& A, const VecX& right, const Filter& filter, const LinearOptions& options,
               double reference, VecX& x, LinearReport& report) {
    const int rows = A.rows(), limit = iteration_limit(options, rows);
    const double target = options.tolerance * reference;
    const auto note = [&](double rr) {
      if (options.history) options.history->push_back(reference > 0 ? std::sqrt(rr) / reference : 0);
    };
    double rr = dot(r_, r_);
    note(rr);
    const double far_off = 1e12 * (rr + reference * reference);  // no sound iteration has such a residual
    int restarts = 0, since_ready = 0;
    // Takes the preconditioner's products, which are off by what floats lose, until that shows.
    bool quick = options.tolerance >= 1e-7;
    double rr_ready = rr;  // rr when the preconditioner was made ready
    const auto decades = [&] { return rr > 0 && rr_ready > 0 ? 0.5 * std::log10(rr_ready / rr) : 0; };
    bool known = false;
    while (report.reason == StopReason::converged) {
      known = false;
      d_.setZero();
      q_.setZero();
      double rho = 1;
      while (rr > target * target && report.iterations < limit &&
             !preconditioner_->outdated(since_ready, decades())) {
        const bool multiplied = quick && preconditioner_->apply_and_multiply(r_, s_, As_);
        if (!quick) preconditioner_->apply(r_, s_);
        filter.apply(s_);
        const double rho_new = dot(r_, s_);
        const bool broken = std::isfinite(rr) && (!(rho_new > 0) || rr > far_off);
        if (broken && preconditioner_->make_safer(A, filter, report)) {
          begin_again(A, right, filter, x);
          rho = 1;
          rr = rr_ready = dot(r_, r_);
          since_ready = 0;
          continue;
        }
        if (!(rho_new > 0)) {
          report.reason = std::isfinite(rho_new) ? StopReason::indefinite : StopReason::not_finite;
          break;
        }
        const double beta = rho_new / rho;
        rho = rho_new;
        const double curvature = next_direction(A, filter, beta, multiplied);
        if (!(curvature > 0)) {
          if (multiplied) break;  // the product may be at fault: goes on with A itself
          report.reason = std::isfinite(curvature) ? StopReason::indefinite : StopReason::not_finite;
          break;
        }
        rr = advance(rho / curvature, rows, x);
        ++report.iterations;
        ++since_ready;
        note(rr);
      }
      if (report.reason != StopReason::converged || !std::isfinite(rr)) break;
      // The recurrence drifts from the true residual by round-off; where that matters, the iteration goes on
      // from the true one.
      residual(A, right, filter, x, r_);
      rr = dot(r_, r_);
      known = true;
      if (rr <= 1.02 * target * target || report.iterations >= limit) break;
      if (preconditioner_->outdated(since_ready, decades())) {
        preconditioner_->learn(since_ready, decades());
        since_ready = 0;
        rr_ready = rr;
        prepare(A, filter, report);
      } else if (quick) {
        quick = false;
      } else if (++restarts > 3) {
        break;
      }
    }
    if (report.reason == StopReason::converged)
      preconditioner_->learn(since_ready, decades());
    else
      preconditioner_->forget();
    return known;
  }

  // d <- s + beta d,  q <- S A d, by A s where it is known. Returns d.q.
  double next_direction(const BlockMatrix& A, const Filter& filter, double beta, bool multiplied) {
    const auto add_to_multiple = [beta](int begin, int end, const VecX& v, VecX& sum) {
      double* to = sum.data();
      const double* from = v.data();
      for (int i = 3 * begin; i < 3 * end; ++i) to[i] = from[i] + beta * to[i];
    };
    if (!multiplied) {
      for_chunks(A.rows(), [&](int begin, int end) { add_to_multiple(begin, end, s_, d_); });
      A.multiply(d_, q_);
      filter.apply(q_);
      return dot(d_, q_);
    }
    A.add_overlay(s_, As_);
    filter.apply(As_);
    return sum_chunks(A.rows(), [&](int begin, int end) {
      add_to_multiple(begin, end, s_, d_);
      add_to_multiple(begin, end, As_, q_);
      return dot_in_order(d_.data() + 3 * begin, q_.data() + 3 * begin, 3 * (end - begin));
    });
  }

  void begin_again(const BlockMatrix& A, const VecX& right, const Filter& filter, VecX& x) {
    x.setZero();
    if (!prefiltered_) filter.impose(x);
    d_.setZero();
    q_.setZero();
    residual(A, right, filter, x, r_);
  }

  // x += alpha d, r -= alpha q. Returns r.r of the new r.
  double advance(double alpha, int rows, VecX& solution) {
    return sum_chunks(rows, [&](int begin, int end) {
      double *x = solution.data(), *r = r_.data();
      const double *d = d_.data(), *q = q_.data();
      for (int i = 3 * begin; i < 3 * end; ++i) {
        x[i] += alpha * d[i];
        r[i] -= alpha * q[i];
      }
      return dot_in_order(r + 3 * begin, r + 3 * begin, 3 * (end - begin));
    });
  }

  void conclude(const LinearOptions& options, double reference, LinearReport& report) {
    report.residual_impulse = std::sqrt(dot(r_, r_));
    report.residual = reference == 0 ? 0 : report.residual_impulse / reference;
    if (!std::isfinite(report.residual_impulse)) report.reason = StopReason::not_finite;
    if (report.reason == StopReason::converged && report.residual > 1.01 * options.tolerance)
      report.reason = StopReason::iteration_limit;
  }

  std::string name_;
  bool prefiltered_;
  std::unique_ptr<Preconditioner> preconditioner_;
  VecX r_, d_, q_, s_, As_, z_, right_;  // d is a search direction, q = S A d, s = P r, As = S A s
};

}  // namespace

std::unique_ptr<LinearSolver> make_pcg(std::string name, bool prefiltered,
                                       std::unique_ptr<Preconditioner> preconditioner) {
  return std::make_unique<Pcg>(std::move(name), prefiltered, std::move(preconditioner));
}

}  // namespace drape::internal
