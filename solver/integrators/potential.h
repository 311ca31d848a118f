// Of the incremental potential Phi(v) (solver/integrators/bdf.h): what all steps have in common, and what round-off makes
// of it. Internal to the library (not installed).
//   Rounding of x and v, in sums of a few terms, is a disturbance e_i = 8 eps (|x_i|/c + |v_i|) of v, and
//   that is at most   N = sum A_ii e_i^2, and N + 2 sqrt(Phi N) of Phi, a sum of squares;   |A_ii e_i| of its
//   gradient. Without gravity, nothing else tells what is small.
// x [m], v [m/s], A [kg], c [s].
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "mesh/base/parallel.h"
#include "solver/integrators/bdf.h"

namespace drape {

// E(x) + c/2 v . D v + what friction of contacts takes in h [J].
inline double potential_of_forces(const System& system, const std::vector<ContactFriction>& friction,
                                  const VecX& x, const VecX& v, double c, double h) {
  double phi = 0;
  for (const auto& force : system.forces()) phi += force->energy(x) + c * force->dissipation(x, v);
  for (const ContactFriction& f : friction) {
    const Vec3 slip = v.segment<3>(3 * f.particle) - f.body_velocity;
    phi += 0.5 * h * slip.dot(f.damping * slip) - f.impulse.dot(slip);
  }
  return phi;
}

inline RoundOff round_off(const BlockMatrix& A, const VecX& x, const VecX& v, double c) {
  constexpr double eps = 8 * std::numeric_limits<double>::epsilon();
  struct Sums {
    double energy = 0, squares = 0;  // of A_ii e_i^2, and of (A_ii e_i)^2
    void operator+=(const Sums& other) { energy += other.energy, squares += other.squares; }
  };
  const Sums all = sum_chunks(A.rows(), [&](int begin, int end) {
    Sums sums;
    for (int i = begin; i < end; ++i) {
      const int row = A.pattern().row_of()[static_cast<std::size_t>(i)];
      const double a = A.at(A.pattern().diagonal(row)).norm();
      const double e = eps * (x.segment<3>(3 * i).norm() / c + v.segment<3>(3 * i).norm());
      sums += {a * e * e, a * e * a * e};
    }
    return sums;
  });
  return {all.energy, std::sqrt(all.squares)};
}

}  // namespace drape
