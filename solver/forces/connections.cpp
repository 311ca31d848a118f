#include "solver/forces/connections.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mesh/base/parallel.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/damping.h"
#include "solver/forces/tension_spring.h"

namespace drape {
namespace {

double clamp_of(const BendConnection& bend, const Fabric& fabric) {
  if (fabric.buckling_clamp) return *fabric.buckling_clamp;
  const double kappa = limp_curvature(bend.B, fabric.area_density),
               k_s = fabric.stretch_spring.value_or(mean_stretch(fabric));
  return std::clamp(bend.clamp_k2 / (kappa * kappa), k_s, stiffest_clamp * k_s);
}

}  // namespace

std::vector<std::unique_ptr<Force>> forces_of(const Connections& connections, const Fabric& fabric,
                                              int first) {
  std::vector<PairForce<TensionSpring>::Element> stretch;
  for (const StretchConnection& s : connections.stretch)
    if (s.k > 0) stretch.push_back({first + s.i, first + s.j, {s.L, s.k}});
  std::vector<BendConnection> stiff;
  std::copy_if(connections.bend.begin(), connections.bend.end(), std::back_inserter(stiff),
               [](const BendConnection& b) { return b.k_b > 0; });
  std::vector<PairForce<BucklingSpring>::Element> bend(stiff.size());
  for_chunks<Work::heavy>(static_cast<int>(stiff.size()), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const BendConnection& b = stiff[k];
      bend[k] = {first + b.i, first + b.j, BucklingSpring::rest(b.L, b.k_b, clamp_of(b, fabric))};
    }
  });
  std::vector<std::unique_ptr<Force>> forces;
  if (fabric.damping > 0) {
    std::vector<PairDamping::Element> damped;
    damped.reserve(stretch.size() + bend.size());
    for (const auto& e : stretch) damped.push_back({e.particles});
    for (const auto& e : bend) damped.push_back({e.particles});
    forces.push_back(std::make_unique<PairDamping>(std::move(damped), fabric.damping, fabric.damping_kind));
  }
  if (!stretch.empty()) forces.push_back(std::make_unique<PairForce<TensionSpring>>(std::move(stretch)));
  if (!bend.empty()) forces.push_back(std::make_unique<PairForce<BucklingSpring>>(std::move(bend)));
  return forces;
}

std::vector<double> neighbour_weighted(std::vector<double> masses, const Connections& connections) {
  std::vector<std::pair<int, int>> connected;
  for (const StretchConnection& s : connections.stretch) connected.push_back(std::minmax(s.i, s.j));
  for (const BendConnection& b : connections.bend) connected.push_back(std::minmax(b.i, b.j));
  std::sort(connected.begin(), connected.end());
  connected.erase(std::unique(connected.begin(), connected.end()), connected.end());
  std::vector<int> neighbours(masses.size(), 0);
  for (const auto& [i, j] : connected) {
    ++neighbours[i];
    ++neighbours[j];
  }
  const int most = neighbours.empty() ? 0 : *std::max_element(neighbours.begin(), neighbours.end());
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (neighbours[i] > 0) masses[i] *= static_cast<double>(neighbours[i]) / most;
  return masses;
}

double limp_curvature(double bend, double area_density) {
  return 0.1 * std::cbrt(area_density * 9.81 / bend);
}

double limp_below(const Connections& connections, const Fabric& fabric) {
  std::vector<double> curvature;
  for (const BendConnection& b : connections.bend)
    if (const double clamp = clamp_of(b, fabric); b.k_b > 0 && clamp > 0)
      curvature.push_back(std::sqrt(b.clamp_k2 / clamp));
  if (curvature.empty()) return 0;
  const auto middle = curvature.begin() + static_cast<std::ptrdiff_t>(curvature.size() / 2);
  std::nth_element(curvature.begin(), middle, curvature.end());
  return *middle;
}

}  // namespace drape
