#include "solver/forces/buckling_spring.h"

#include <array>

namespace drape {
namespace {

// Power series in y = u^2 of three entire functions; with them no digits are lost near the straight state:
//   S = (1 - sinc u) / y,   C = (cos u - sinc u) / y,   N = (3 C + 1 - y S) / y
constexpr int terms = 14;
struct Series {
  std::array<double, terms> S, C, N;
};

constexpr Series make_series() {
  Series s{};
  double factorial = 6;  // (2n + 3)!
  double sign = 1;       // (-1)^n
  for (int n = 0; n < terms; ++n) {
    const double next = factorial * (2 * n + 4) * (2 * n + 5);  // (2n + 5)!
    const auto k = static_cast<std::size_t>(n);
    s.S[k] = sign / factorial;
    s.C[k] = -sign * (2 * n + 2) / factorial;
    s.N[k] = -sign * (2 * n + 2) * (2 * n + 4) / next;
    factorial = next;
    sign = -sign;
  }
  return s;
}

constexpr Series series = make_series();

// A first guess of y for a given delta: a fit with a relative error of 5e-4 over [0, 1].
double first_guess(double delta) {
  return delta *
         (5.99860042 +
          delta * (1.89802036 + delta * (-0.24499775 +
                                         delta * (4.47265052 + delta * (-5.98226664 + delta * 3.72304021)))));
}

// The y = u^2 at which sinc(u) = 1 - delta.
double squared_angle(double delta) {
  double y = first_guess(delta);
  for (int round = 0; round < 2; ++round) {  // Halley's method on G(y) = y S(y) - delta, with G' = -C / 2
    double S = series.S[terms - 1], C = series.C[terms - 1], dC = 0;
    for (std::size_t n = terms - 1; n-- > 0;) {
      dC = dC * y + C;
      C = C * y + series.C[n];
      S = S * y + series.S[n];
    }
    const double G = y * S - delta, G1 = -0.5 * C, G2 = -0.5 * dC;
    y -= 2 * G * G1 / (2 * G1 * G1 - G * G2);
  }
  return y;
}

}  // namespace

Buckling immediate_buckling(double delta) {
  const double y = squared_angle(delta);
  double C = series.C[terms - 1], N = series.N[terms - 1];
  for (std::size_t n = terms - 1; n-- > 0;) {
    C = C * y + series.C[n];
    N = N * y + series.N[n];
  }
  return {2 * y, 4 / C, 4 * N / (C * C * C)};
}

double buckling_energy(double delta) { return 2 * squared_angle(delta); }

double clamp_crossing(double c_hat) {
  constexpr double four_pi_squared = 39.478417604357434;
  if (!(c_hat > four_pi_squared)) return 1;
  double low = 0, high = 1;  // c_hat delta + force(delta) is < 0 at low and > 0 at high
  for (int k = 0; k < 80; ++k) {
    const double mid = 0.5 * (low + high);
    (c_hat * mid + immediate_buckling(mid).force < 0 ? low : high) = mid;
  }
  return high;
}

BucklingSpring::Rest BucklingSpring::rest(double L, double k_b, double c_b) {
  const double crossing = clamp_crossing(c_b * L * L * L / k_b), linear = crossing * L;
  return {L, k_b, c_b, crossing, 0.5 * c_b * linear * linear - k_b / L * buckling_energy(crossing)};
}

double BucklingSpring::energy(const Rest& r, double l) {
  const double delta = (r.L - l) / r.L;
  if (delta <= 0) return 0;
  if (delta <= r.crossing) return 0.5 * r.c_b * (r.L - l) * (r.L - l);
  return r.offset + r.k_b / r.L * buckling_energy(delta);
}

}  // namespace drape
