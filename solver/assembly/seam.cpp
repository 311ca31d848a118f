#include "solver/assembly/seam.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/pattern/panels.h"
#include "solver/forces/pair_force.h"
#include "solver/forces/seam_spring.h"

namespace drape {
namespace {

using SeamForce = PairForce<SeamSpring>;

const Vec3& at(const std::vector<Vec3>& positions, int v) { return positions[v]; }

// Where the vertices rest. A vertex that lies in several panels is given one of its places.
std::vector<Vec3> rest_places(const TriangleMesh& mesh, const TriangleMesh& rest) {
  std::vector<Vec3> places = mesh.positions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      places[mesh.triangles[t][k]] = at(rest.positions, rest.triangles[t][k]);
  return places;
}

void check(const SeamPlan& plan, int vertices) {
  const std::string name = "seam " + plan.name + ": ";
  if (plan.pairs.empty()) throw InputError(name + "has no pairs of vertices; give at least one");
  for (const auto& [a, b] : plan.pairs)
    if (std::min(a, b) < 0 || std::max(a, b) >= vertices)
      throw InputError(name + "sews vertex " + std::to_string(a) + " to " + std::to_string(b) +
                       ", but the mesh has the vertices 0 to " + std::to_string(vertices - 1));
  if (!(plan.close >= 0) || !std::isfinite(plan.close))
    throw InputError(name + "closes at " + std::to_string(plan.close) +
                     " s; a time is a finite number and not negative");
  if (plan.stiffness && !(*plan.stiffness > 0 && std::isfinite(*plan.stiffness)))
    throw InputError(name + "has a stiffness of " + std::to_string(*plan.stiffness) +
                     " N/m; a stiffness is a finite number greater than zero");
}

// The mean length at rest of the edges at both vertices [m].
double mean_edge_at(const std::pair<int, int>& pair, const TriangleMesh& mesh,
                    const std::vector<Vec3>& places) {
  double sum = 0;
  int count = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (a != pair.first && a != pair.second && b != pair.first && b != pair.second) continue;
      sum += (at(places, a) - at(places, b)).norm();
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

OpenSeam open_seam(const SeamPlan& plan, const Fabric& fabric, const TriangleMesh& mesh,
                   const std::vector<Vec3>& places) {
  check(plan, mesh.vertex_count());
  OpenSeam seam;
  seam.name = plan.name;
  for (std::size_t k = 0; k < plan.pairs.size(); ++k) {
    const auto& [a, b] = plan.pairs[k];
    if (k > 0) {
      const auto& [a_before, b_before] = plan.pairs[k - 1];
      seam.length_one += (at(places, a) - at(places, a_before)).norm();
      seam.length_two += (at(places, b) - at(places, b_before)).norm();
    }
    if (a == b) continue;  // both curves begin or end in this vertex
    seam.pairs.emplace_back(a, b);
    seam.apart.push_back((at(mesh.positions, a) - at(mesh.positions, b)).norm());
  }
  const std::size_t edges = plan.pairs.size() - 1;
  seam.edge = edges == 0 ? mean_edge_at(plan.pairs.front(), mesh, places)
                         : 0.5 * (seam.length_one + seam.length_two) / static_cast<double>(edges);
  seam.close = plan.close;
  seam.merge = plan.merge;
  // A seam that will be merged is as stiff as the cloth while it closes; one that is kept for good is held
  // much harder.
  constexpr double kept = 1000;
  const double cloth = std::max(fabric.stretch_spring.value_or(mean_stretch(fabric)), 1e-3);
  seam.stiffness = plan.stiffness.value_or(seam.merge ? cloth : kept * cloth);
  return seam;
}

double distance_of(const std::pair<int, int>& pair, const Embedding& embedding, const VecX& x) {
  const int i = embedding.particle(pair.first), j = embedding.particle(pair.second);
  return (x.segment<3>(3 * i) - x.segment<3>(3 * j)).norm();
}

}  // namespace

std::vector<SeamPlan> declared_seam_plans(const TriangleMesh& mesh, double close) {
  std::vector<SeamPlan> plans;
  const std::vector<Polyline> lines = polylines(mesh);
  for (const Seam& seam : declared_seams(mesh))
    plans.push_back({.name = seam.a + " / " + seam.b, .pairs = seam_pairs(lines, seam), .close = close});
  return plans;
}

double OpenSeam::gap(const Embedding& embedding, const VecX& x) const {
  double widest = 0;
  for (const auto& pair : pairs) {
    const double wide = distance_of(pair, embedding, x);
    if (!(wide <= widest)) widest = wide;  // a gap that is not a number does not count as closed
  }
  return widest;
}

bool OpenSeam::begins_closed(std::size_t pair) const { return apart[pair] < closed_already * edge; }

bool OpenSeam::begins_closed() const {
  return std::ranges::all_of(apart, [&](double distance) { return distance < closed_already * edge; });
}

std::vector<std::pair<int, int>> OpenSeam::take_closed(const Embedding& embedding, const State& state) {
  const double near = near_enough * edge;
  if (!merge) return {};
  if (state.time >= close * (1 - 1e-9) && gap(embedding, state.x) <= near) return std::exchange(pairs, {});
  std::vector<std::pair<int, int>> closed;
  std::size_t open = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (begins_closed(k) && distance_of(pairs[k], embedding, state.x) <= near) {
      closed.push_back(pairs[k]);
      continue;
    }
    pairs[open] = pairs[k];
    apart[open++] = apart[k];
  }
  pairs.resize(open);
  apart.resize(open);
  return closed;
}

std::vector<OpenSeam> open_seams(const std::vector<SeamPlan>& plans, const Fabric& fabric,
                                 const TriangleMesh& mesh, const TriangleMesh& rest) {
  std::vector<OpenSeam> seams;
  if (plans.empty()) return seams;
  const std::vector<Vec3> places = rest_places(mesh, rest);
  for (const SeamPlan& plan : plans) seams.push_back(open_seam(plan, fabric, mesh, places));
  return seams;
}

std::unique_ptr<Force> stitches(const OpenSeam& seam, const Embedding& embedding, double t) {
  std::vector<SeamForce::Element> elements;
  for (std::size_t k = 0; k < seam.pairs.size(); ++k) {
    const int i = embedding.particle(seam.pairs[k].first), j = embedding.particle(seam.pairs[k].second);
    SeamSpring::Rest rest;
    rest.k = seam.stiffness;
    rest.L_0 = seam.apart[k];
    if (i != j) elements.push_back({i, j, rest});
  }
  if (elements.empty()) return nullptr;
  auto force = std::make_unique<SeamForce>(std::move(elements));
  close_until(*force, seam, t);
  return force;
}

void close_until(Force& force, const OpenSeam& seam, double t) {
  const double open = SeamSpring::open(t, seam.close);
  static_cast<SeamForce&>(force).change_rest([&](SeamSpring::Rest& r) { r.L = open * r.L_0; });
}

std::vector<int> merged(const std::vector<int>& number, const std::vector<std::pair<int, int>>& pairs,
                        const Embedding& embedding) {
  std::vector<int> lower(number.size());  // union-find among the numbers, towards the lowest
  std::iota(lower.begin(), lower.end(), 0);
  const auto root = [&](int i) {
    while (lower[i] != i) i = lower[i];
    return i;
  };
  const auto root_of = [&](int vertex) { return root(number[embedding.particle(vertex)]); };
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax({root_of(a), root_of(b)});
    lower[high] = low;
  }
  const int before = number.empty() ? 0 : 1 + *std::max_element(number.begin(), number.end());
  std::vector<int> again(lower.size()), result = number;
  int count = 0;
  for (int i = 0; i < before; ++i) again[i] = root(i) == i ? count++ : again[root(i)];
  for (int& n : result) n = again[n];
  return result;
}

}  // namespace drape
