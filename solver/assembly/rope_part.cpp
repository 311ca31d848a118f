// A rope becomes a part of an assembly: its points become particles, but for ends that are joined to others.
#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/extent.h"
#include "solver/assembly/assembly.h"

namespace drape {
namespace {

MeshReport report_of(const std::vector<Vec3>& points, std::vector<double> lengths) {
  MeshReport report;
  report.vertices = static_cast<int>(points.size());
  report.edges = static_cast<int>(lengths.size());
  report.pieces = 1;
  const Eigen::AlignedBox3d box = box_of(points);
  report.lower = box.min();
  report.upper = box.max();
  std::sort(lengths.begin(), lengths.end());
  report.shortest_edge = lengths.front();
  report.median_edge = lengths[lengths.size() / 2];
  report.longest_edge = lengths.back();
  return report;
}

}  // namespace

// Lets the segments of the next rope take part in contact with cloth and ropes.
void Assembly::meet(const Cloth& rope, const RopeContact& options) {
  if (!(options.friction >= 0) || !std::isfinite(options.friction))
    throw InputError(rope.name + ": friction = " + std::to_string(options.friction) +
                     ": it is finite and not negative");
  for (const RestEdge& edge : rope.edges)
    self_segments_.push_back(
        {{edge.i, edge.j}, 2 * rope.rope->radius, options.friction, static_cast<int>(cloths.size())});
}

Cloth& Assembly::add(RopePart part) {
  if (system) throw InputError(part.name + ": is added after use(); add all ropes before it");
  const std::size_t n = part.points.size();
  const auto joined = [&](std::size_t k) -> const std::optional<int>& {
    static const std::optional<int> none;
    return k == 0 ? part.first : k + 1 == n ? part.last : none;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const std::optional<int>& to = joined(k);
    if (!part.points[k].allFinite())
      throw InputError(part.name + ": point " + std::to_string(k) + " is not finite");
    if (!to) continue;
    if (*to < 0 || *to >= state.particles())
      throw InputError(part.name + ": is joined to particle " + std::to_string(*to) + ", but there are " +
                       std::to_string(state.particles()) + " so far");
    part.points[k] = state.x.segment<3>(3 * *to);
  }
  Cloth cloth;
  cloth.name = std::move(part.name);
  const std::vector<double> masses = rope_masses(part.points, part.material);
  if (part.first && part.last && n < 3)
    throw InputError(cloth.name + ": both ends are joined, so it needs two segments at least");
  cloth.rope = part.material;
  cloth.mesh = line_mesh(part.points, cloth.name);
  cloth.rest = cloth.mesh;
  cloth.first_particle = cloth.end_particle = state.particles();
  std::vector<Vec3> own;
  std::vector<double> own_masses, lengths;
  for (std::size_t k = 0; k < n; ++k) {
    if (const std::optional<int>& to = joined(k)) {
      cloth.embedding.add_vertex(*to);
      masses_[static_cast<std::size_t>(*to)] += masses[k];
      continue;
    }
    constraints->set_radius(cloth.end_particle, part.material.radius);
    cloth.embedding.add_vertex(cloth.end_particle++);
    own.push_back(part.points[k]);
    own_masses.push_back(masses[k]);
  }
  for (std::size_t k = 1; k < n; ++k) {
    lengths.push_back((part.points[k] - part.points[k - 1]).norm());
    const auto vertex = static_cast<int>(k);
    cloth.edges.push_back(
        {cloth.embedding.particle(vertex - 1), cloth.embedding.particle(vertex), lengths.back()});
  }
  cloth.report = report_of(part.points, std::move(lengths));
  connect(cloth, forces_);
  if (part.self_contact) meet(cloth, *part.self_contact);
  return take(std::move(cloth), own, own_masses);
}

}  // namespace drape
