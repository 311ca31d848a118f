#include "solver/forces/rope.h"

#include <string>

#include "mesh/base/errors.h"
#include "solver/forces/require.h"
#include "solver/forces/rope_laws.h"

namespace drape {
namespace {

constexpr double least_curvature = 1e-3;  // q_0 / d [1/m]

// Of each segment [m].
std::vector<double> lengths_of(const std::vector<Vec3>& points) {
  if (points.size() < 2)
    throw InputError("a rope of " + std::to_string(points.size()) +
                     (points.size() == 1 ? " point" : " points") + "; expected at least two");
  std::vector<double> lengths;
  for (std::size_t k = 1; k < points.size(); ++k) {
    lengths.push_back((points[k] - points[k - 1]).norm());
    if (!(lengths.back() > 0))
      throw InputError("points " + std::to_string(k - 1) + " and " + std::to_string(k) +
                       " of a rope are at one place; leave one of them out");
  }
  return lengths;
}

}  // namespace

void check(const RopeMaterial& m) {
  require(m.mass_per_length > 0, "mass_per_length", m.mass_per_length, "kg/m", "a mass is greater than zero");
  require(m.stretch > 0, "stretch", m.stretch, "N", "a stiffness of a rope is greater than zero");
  require(m.bend >= 0, "bend", m.bend, "N.m^2", "a stiffness is not negative");
  require(m.damping >= 0, "damping", m.damping, "N.s", "a damping coefficient is not negative");
  require(m.bend_damping >= 0, "bend_damping", m.bend_damping, "N.m^2.s",
          "a damping coefficient is not negative");
  require(m.radius > 0, "radius", m.radius, "m", "a radius is greater than zero");
}

std::vector<double> rope_masses(const std::vector<Vec3>& points, const RopeMaterial& material) {
  check(material);
  std::vector<double> masses(points.size(), 0.0);
  const std::vector<double> lengths = lengths_of(points);
  for (std::size_t k = 0; k < lengths.size(); ++k)
    for (const std::size_t end : {k, k + 1}) masses[end] += 0.5 * material.mass_per_length * lengths[k];
  return masses;
}

std::vector<std::unique_ptr<Force>> rope_forces(const std::vector<Vec3>& points,
                                                std::span<const int> particles,
                                                const RopeMaterial& material) {
  check(material);
  const std::vector<double> L = lengths_of(points);
  std::vector<PairForce<RopeStretch>::Element> segments;
  std::vector<StencilForce<RopeBend>::Element> bends;
  std::vector<StencilForce<RopeBendDamping>::Element> dampers;
  for (std::size_t k = 0; k < L.size(); ++k) {
    const int i = particles[k], j = particles[k + 1];
    if (i != j) segments.push_back({{i, j}, {L[k], material.stretch / L[k]}});
    if (k == 0) continue;
    const int before = particles[k - 1];
    const double d = 0.5 * (L[k - 1] + L[k]);
    if (before == i || i == j || before == j) continue;  // two of them have been sewn together
    if (material.bend > 0) bends.push_back({{before, i, j}, {L[k - 1], L[k], material.bend / d}});
    if (material.bend_damping > 0)
      dampers.push_back({{before, i, j}, {L[k - 1], L[k], material.bend_damping / d, least_curvature * d}});
  }
  std::vector<std::unique_ptr<Force>> forces;
  if (!segments.empty())
    forces.push_back(std::make_unique<PairForce<RopeStretch>>(std::move(segments), material.damping));
  if (!bends.empty()) forces.push_back(std::make_unique<StencilForce<RopeBend>>(std::move(bends)));
  if (!dampers.empty()) forces.push_back(std::make_unique<StencilForce<RopeBendDamping>>(std::move(dampers)));
  return forces;
}

}  // namespace drape
