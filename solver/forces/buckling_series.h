// The dimensionless law of a beam that buckles into a circular arc (solver/forces/buckling_spring.h), for a
// Number that is a double or four of them: it does the same with each.
#pragma once

#include <array>
#include <cstddef>

namespace drape::internal {

// Power series in y = u^2 of three entire functions; with them no digits are lost near the straight state:
//   S = (1 - sinc u) / y,   C = (cos u - sinc u) / y,   N = (3 C + 1 - y S) / y
inline constexpr int terms = 14;
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

inline constexpr Series series = make_series();

// A first guess of y = u^2 for a given delta: y / delta by a polynomial, with a relative error of 1.7e-6 over
// [0, 1].
inline constexpr std::array<double, 11> first_guess = {6.00000987, 1.79775804,  0.906505409, -0.761262068,
                                                       9.09424265, -36.9159818, 95.0077116,  -150.586427,
                                                       145.215122, -77.9596806, 18.0715896};

template <class Number>
Number first_squared_angle(const Number& delta) {
  Number quotient = first_guess.back() + Number{};
  for (std::size_t n = first_guess.size() - 1; n-- > 0;) quotient = quotient * delta + first_guess[n];
  return delta * quotient;
}

// y: the u^2 at which sinc(u) = 1 - delta. One step of Halley's method on G(y) = y S(y) - delta, with G' = -C
// / 2, brings the relative error to 6e-16.
template <class Number>
void find_squared_angle(const Number& delta, Number& y) {
  y = first_squared_angle(delta);
  Number S = series.S[terms - 1] + Number{}, C = series.C[terms - 1] + Number{}, dC = {};
  for (std::size_t n = terms - 1; n-- > 0;) {
    dC = dC * y + C;
    C = C * y + series.C[n];
    S = S * y + series.S[n];
  }
  const Number G = y * S - delta, G1 = -0.5 * C, G2 = -0.5 * dC;
  y -= 2 * G * G1 / (2 * G1 * G1 - G * G2);
}

// force: t L^2 / k_b; stiffness: dt/dl L^3 / k_b.
template <class Number>
void find_buckling(const Number& delta, Number& y, Number& force, Number& stiffness) {
  find_squared_angle(delta, y);
  Number C = series.C[terms - 1] + Number{}, N = series.N[terms - 1] + Number{};
  for (std::size_t n = terms - 1; n-- > 0;) {
    C = C * y + series.C[n];
    N = N * y + series.N[n];
  }
  force = 4 / C;
  stiffness = 4 * N / (C * C * C);
}

}  // namespace drape::internal
