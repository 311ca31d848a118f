#include "solver/fabric.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "mesh/obj.h"
#include "mesh/topology.h"
#include "solver/buckling_spring.h"
#include "solver/damping.h"
#include "solver/tension_spring.h"

namespace drape {
namespace {

void require(bool good, const char* field, double value, const char* unit, const char* what) {
  if (good && std::isfinite(value)) return;
  std::ostringstream message;
  message << field << " = " << value << " " << unit << ": " << what;
  throw InputError(message.str());
}

// A diagonal with the sums over the hinges it spans.
struct BendConnection {
  int c, d;
  double L;         // m
  double k_b;       // N m^2
  double clamp_k2;  // N/m/m^2: c_b times the square of the curvature below which it goes limp
  double B;         // N m: the bending rigidity that k_b amounts to here
};

std::vector<BendConnection> bend_connections(const TriangleMesh& mesh, const Fabric& fabric) {
  std::vector<BendConnection> out;
  for (const Hinge& hinge : hinges(mesh)) {
    const Vec3 &a = mesh.positions[static_cast<std::size_t>(hinge.a)],
               &b = mesh.positions[static_cast<std::size_t>(hinge.b)];
    const Vec3 &c = mesh.positions[static_cast<std::size_t>(hinge.c)],
               &d = mesh.positions[static_cast<std::size_t>(hinge.d)];
    const double l = (b - a).norm(), L = (d - c).norm();
    if (l == 0 || L == 0) continue;
    // Slivers would be infinitely stiff: a height counts for at least a fifth of the edge.
    double h1 = (b - a).cross(c - a).norm() / l, h2 = (b - a).cross(d - a).norm() / l;
    if (h1 < 1e-9 * l || h2 < 1e-9 * l) continue;
    h1 = std::max(h1, 0.2 * l);
    h2 = std::max(h2, 0.2 * l);
    const double per_rigidity = l * L * L * L / (6 * h1 * h2 * (h1 + h2));
    const double k_b = fabric.bend_spring.value_or(fabric.bend * per_rigidity);
    const double clamp_k2 = 96 * k_b / (L * h1 * h2 * (h1 + h2) * (h1 + h2));
    if (!out.empty() && out.back().c == hinge.c && out.back().d == hinge.d) {
      if (!fabric.bend_spring) out.back().k_b += k_b;
      out.back().clamp_k2 = std::max(out.back().clamp_k2, clamp_k2);
    } else {
      out.push_back({hinge.c, hinge.d, L, k_b, clamp_k2, k_b / per_rigidity});
    }
  }
  return out;
}

std::vector<PairForce<TensionSpring>::Element> stretch_elements(const TriangleMesh& mesh,
                                                                const Fabric& fabric, int first) {
  std::vector<PairForce<TensionSpring>::Element> elements;
  const std::vector<Edge> all = edges(mesh);
  std::vector<double> area(all.size(), 0.0);
  for (int counted : counted_triangles(mesh)) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(counted)];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      const auto it =
          std::lower_bound(all.begin(), all.end(), std::pair(a, b),
                           [](const Edge& e, const auto& key) { return std::pair(e.a, e.b) < key; });
      if (it != all.end() && it->a == a && it->b == b)
        area[static_cast<std::size_t>(it - all.begin())] += triangle_area(mesh, t);
    }
  }
  for (std::size_t e = 0; e < all.size(); ++e) {
    const Edge& edge = all[e];
    const double l =
        (mesh.positions[static_cast<std::size_t>(edge.a)] - mesh.positions[static_cast<std::size_t>(edge.b)])
            .norm();
    double k = l == 0 ? fabric.stretch : fabric.stretch * area[e] / (l * l);
    if (fabric.stretch_spring) k = *fabric.stretch_spring;
    if (k > 0) elements.push_back({first + edge.a, first + edge.b, {l, k}});
  }
  return elements;
}

double clamp_of(const BendConnection& bend, const Fabric& fabric) {
  if (fabric.buckling_clamp) return *fabric.buckling_clamp;
  const double kappa = limp_curvature(bend.B, fabric.area_density),
               k_s = fabric.stretch_spring.value_or(fabric.stretch);
  return std::clamp(bend.clamp_k2 / (kappa * kappa), k_s, stiffest_clamp * k_s);
}

}  // namespace

void check(const Fabric& f) {
  require(f.area_density > 0, "area_density", f.area_density, "kg/m^2",
          "an area density is greater than zero");
  require(f.stretch >= 0, "stretch", f.stretch, "N/m", "a stiffness is not negative");
  require(f.bend >= 0, "bend", f.bend, "N.m", "a bending rigidity is not negative");
  if (f.stretch_spring)
    require(*f.stretch_spring >= 0, "stretch_spring", *f.stretch_spring, "N/m",
            "a stiffness is not negative");
  if (f.bend_spring)
    require(*f.bend_spring >= 0, "bend_spring", *f.bend_spring, "N.m^2", "a stiffness is not negative");
  if (f.buckling_clamp)
    require(*f.buckling_clamp >= 0, "buckling_clamp", *f.buckling_clamp, "N/m",
            "a stiffness is not negative");
  require(f.damping >= 0, "damping", f.damping, "N.s/m", "a damping coefficient is not negative");
}

std::vector<double> lumped_mass(const TriangleMesh& mesh, double area_density) {
  std::vector<double> mass = vertex_areas(mesh);
  std::vector<char> used(mass.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int i : t) used[static_cast<std::size_t>(i)] = 1;
  double total = 0;
  int count = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    total += mass[i];
    count += used[i];
  }
  for (std::size_t i = 0; i < mass.size(); ++i)
    mass[i] = area_density * (used[i] ? std::max(mass[i], 1e-3 * total / count) : 0.0);
  return mass;
}

std::vector<double> neighbour_weighted(std::vector<double> masses, const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> connected;
  for (const Edge& e : edges(mesh)) connected.emplace_back(e.a, e.b);
  for (const Diagonal& d : diagonals(mesh)) connected.emplace_back(d.c, d.d);
  std::sort(connected.begin(), connected.end());
  connected.erase(std::unique(connected.begin(), connected.end()), connected.end());
  std::vector<int> neighbours(masses.size(), 0);
  for (const auto& [i, j] : connected) {
    ++neighbours[static_cast<std::size_t>(i)];
    ++neighbours[static_cast<std::size_t>(j)];
  }
  const int most = neighbours.empty() ? 0 : *std::max_element(neighbours.begin(), neighbours.end());
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (neighbours[i] > 0) masses[i] *= static_cast<double>(neighbours[i]) / most;
  return masses;
}

std::vector<double> masses(const TriangleMesh& mesh, const Fabric& fabric) {
  std::vector<double> lumped = lumped_mass(mesh, fabric.area_density);
  return fabric.neighbour_weighting ? neighbour_weighted(std::move(lumped), mesh) : lumped;
}

std::vector<std::unique_ptr<Force>> noh_jung(const TriangleMesh& mesh, const Fabric& fabric,
                                             int first_particle) {
  check(fabric);
  std::vector<std::unique_ptr<Force>> forces;
  auto stretch = stretch_elements(mesh, fabric, first_particle);
  std::vector<PairForce<BucklingSpring>::Element> bend;
  for (const BendConnection& b : bend_connections(mesh, fabric)) {
    if (b.k_b > 0)
      bend.push_back({first_particle + b.c, first_particle + b.d,
                      BucklingSpring::rest(b.L, b.k_b, clamp_of(b, fabric))});
  }
  if (fabric.damping > 0) {
    std::vector<PairDamping::Element> damped;
    damped.reserve(stretch.size() + bend.size());
    for (const auto& e : stretch) damped.push_back({e.i, e.j});
    for (const auto& e : bend) damped.push_back({e.i, e.j});
    forces.push_back(std::make_unique<PairDamping>(std::move(damped), fabric.damping, fabric.damping_kind));
  }
  if (!stretch.empty()) forces.push_back(std::make_unique<PairForce<TensionSpring>>(std::move(stretch)));
  if (!bend.empty()) forces.push_back(std::make_unique<PairForce<BucklingSpring>>(std::move(bend)));
  return forces;
}

double limp_curvature(double bend, double area_density) {
  return 0.1 * std::cbrt(area_density * 9.81 / bend);
}

double limp_below(const TriangleMesh& mesh, const Fabric& fabric) {
  std::vector<double> curvature;
  for (const BendConnection& b : bend_connections(mesh, fabric))
    if (const double clamp = clamp_of(b, fabric); b.k_b > 0 && clamp > 0)
      curvature.push_back(std::sqrt(b.clamp_k2 / clamp));
  if (curvature.empty()) return 0;
  const auto middle = curvature.begin() + static_cast<std::ptrdiff_t>(curvature.size() / 2);
  std::nth_element(curvature.begin(), middle, curvature.end());
  return *middle;
}

}  // namespace drape
