#include "solver/stability/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape {
namespace {

struct Pair {
  double x, v;
};

// One step of the method on a vibration, as solver/integrators/explicit.cpp takes it.
Pair stepped(const Tableau& t, const Mode& mode, double h, const Pair& start) {
  std::array<Pair, 4> slope = {};
  for (std::size_t i = 0; i < static_cast<std::size_t>(t.stages); ++i) {
    Pair at = start;
    for (std::size_t j = 0; j < i; ++j) {
      at.x += h * t.a[i][j] * slope[j].x;
      at.v += h * t.a[i][j] * slope[j].v;
    }
    slope[i] = {at.v, -mode.omega2 * at.x - mode.d * at.v};
  }
  Pair end = start;
  for (std::size_t i = 0; i < static_cast<std::size_t>(t.stages); ++i) {
    if (!t.positions_last) end.x += h * t.b[i] * slope[i].x;
    end.v += h * t.b[i] * slope[i].v;
  }
  if (t.positions_last) end.x += h * end.v;
  return end;
}

constexpr double round_off = 1e-13;  // relative to an amplification of 1

}  // namespace

double amplification(const Tableau& tableau, const Mode& mode, double h) {
  // The matrix is written for x and v / w, so that its entries are of one size.
  const double w = std::max({std::sqrt(mode.omega2), mode.d, 1e-300});
  const Pair a = stepped(tableau, mode, h, {1, 0}), b = stepped(tableau, mode, h, {0, w});
  const double half_trace = 0.5 * (a.x + b.v / w), determinant = (a.x * b.v - b.x * a.v) / w;
  const double root = half_trace * half_trace - determinant;
  return root >= 0 ? std::abs(half_trace) + std::sqrt(root) : std::sqrt(determinant);
}

double step_limit(const Tableau& tableau, const Mode& mode) {
  const double w = std::sqrt(mode.omega2), fastest = w + mode.d;  // >= |lambda| of the mode
  if (fastest == 0) return std::numeric_limits<double>::infinity();
  const auto grows = [&](double h) { return amplification(tableau, mode, h) > 1 + round_off; };
  constexpr double first = 1e-6, last = 100, ratio = 1.002;
  double stable = 0, grown = 0;
  for (double z = first; z < last && grown == 0; z *= ratio)
    (grows(z / fastest) ? grown : stable) = z / fastest;
  if (grown == 0) return std::numeric_limits<double>::infinity();
  while (grown - stable > 1e-12 * grown) {
    const double middle = 0.5 * (stable + grown);
    if (middle == stable || middle == grown) break;
    (grows(middle) ? grown : stable) = middle;
  }
  constexpr double none = 1e-3;  // below this, the growth of a step is round-off
  return stable * fastest < none && mode.d < none * w ? 0 : stable;
}

double Spectrum::omega() const { return modes.empty() ? 0 : std::sqrt(modes.front().omega2); }

double step_limit(const Tableau& tableau, const Spectrum& spectrum) {
  double least = std::numeric_limits<double>::infinity();
  for (const Mode& mode : spectrum.modes) least = std::min(least, step_limit(tableau, mode));
  return least;
}

}  // namespace drape
