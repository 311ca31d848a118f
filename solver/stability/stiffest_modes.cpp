// The stiffest modes of a system: the largest eigenvalues of S M^-1/2 K M^-1/2 S by Lanczos' method with
// implicit restarts; S leaves out the particles that are pinned or have no mass. Only this file includes
// Spectra.
#include <Spectra/SymEigsSolver.h>

#include <cmath>
#include <stdexcept>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"
#include "solver/stability/stability.h"

namespace drape {
namespace {

// A block matrix A between two diagonal matrices W: y = W A W x, in row order.
class Scaled {
 public:
  using Scalar = double;
  Scaled(const BlockMatrix& A, const VecX& weights) : A_(A), weights_(weights) {}
  Eigen::Index rows() const { return weights_.size(); }
  Eigen::Index cols() const { return weights_.size(); }
  void perform_op(const double* x, double* y) const {
    scratch_ = weights_.cwiseProduct(Eigen::Map<const VecX>(x, rows()));
    product_.resize(rows());
    A_.multiply(scratch_, product_);
    Eigen::Map<VecX>(y, rows()) = weights_.cwiseProduct(product_);
  }

 private:
  const BlockMatrix& A_;
  const VecX& weights_;
  mutable VecX scratch_, product_;
};

// m^-1/2 [kg^-1/2] of each row, and 0 where its particle is held.
VecX inverse_root_masses(const System& system, const Constraints& constraints, const BlockPattern& pattern) {
  VecX by_particle(3 * system.particles());
  for (int i = 0; i < system.particles(); ++i) {
    const double m = system.masses()[i];
    by_particle.segment<3>(3 * i).setConstant(m > 0 ? 1 / std::sqrt(m) : 0);
  }
  for (int i : constraints.pinned()) by_particle.segment<3>(3 * i).setZero();
  VecX rows(by_particle.size());
  to_rows(pattern, by_particle, rows);
  return rows;
}

double form(const BlockMatrix& A, const VecX& x) {
  VecX product(x.size());
  A.multiply(x, product);
  return dot(x, product);
}

// The trace of W K W; it is 0 where no force resists the free particles.
double stiffness_of_free(const BlockMatrix& K, const VecX& weights) {
  double trace = 0;
  for (int row = 0; row < K.pattern().rows(); ++row)
    trace += weights.segment<3>(3 * row).cwiseAbs2().dot(K.at(K.pattern().diagonal(row)).diagonal());
  return trace;
}

// K and D are found from the sums A = c D + c^2 K that the forces give with c = 1 and with c = 2.
struct Matrices {
  BlockMatrix K, D;
  Matrices(System& system, const State& state) : K(system.bind()), D(system.bind()) {
    const std::vector<double> none(system.masses().size(), 0.0);
    const VecX still = VecX::Zero(state.x.size());
    VecX b = still;
    BlockMatrix one = system.matrix(), two = one;
    one.set_to_mass(none);
    two.set_to_mass(none);
    for (const auto& force : system.forces()) {
      force->add_linearised(state.x, still, still, 1, Stiffness::majorant, one, b);
      force->add_linearised(state.x, still, still, 2, Stiffness::majorant, two, b);
    }
    for (int s = 0; s < K.pattern().blocks(); ++s) {
      K.at(s) = 0.5 * two.at(s) - one.at(s);      // (2 D + 4 K) / 2 - (D + K)
      D.at(s) = 2 * one.at(s) - 0.5 * two.at(s);  // 2 (D + K) - (2 D + 4 K) / 2
    }
  }

  bool proportional() const {
    double kk = 0, kd = 0, dd = 0;
    for (int s = 0; s < K.pattern().blocks(); ++s) {
      kk += K.at(s).squaredNorm();
      kd += K.at(s).cwiseProduct(D.at(s)).sum();
      dd += D.at(s).squaredNorm();
    }
    return kk == 0 || dd <= 1e-16 * kk || kd * kd >= (1 - 1e-10) * kk * dd;
  }
};

}  // namespace

Spectrum stiffest_modes(System& system, const Constraints& constraints, const State& state, int count) {
  check_step(system, state, 1);
  const Matrices at(system, state);
  const VecX weights = inverse_root_masses(system, constraints, at.K.pattern());
  Spectrum spectrum;
  spectrum.proportional = at.proportional();
  const auto n = static_cast<int>(weights.size());
  const int wanted = std::min(count, n - 1);
  if (wanted < 1 || stiffness_of_free(at.K, weights) == 0) return spectrum;
  Scaled op(at.K, weights);
  Spectra::SymEigsSolver<Scaled> solver(op, wanted, std::min(n, std::max(40, 4 * wanted)));
  solver.init();
  constexpr int restarts = 2000;
  constexpr double precision = 1e-8;
  solver.compute(Spectra::SortRule::LargestAlge, restarts, precision);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("the highest frequency could not be found: Lanczos' method did not converge");
  const VecX values = solver.eigenvalues();
  const Eigen::MatrixXd vectors = solver.eigenvectors();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (!(values[k] > 0)) continue;
    const VecX u = weights.cwiseProduct(vectors.col(k));
    const double d = form(at.D, u);
    spectrum.modes.push_back({values[k], d > 1e-12 * values[k] ? d : 0});  // a smaller d is round-off of K
  }
  return spectrum;
}

}  // namespace drape
