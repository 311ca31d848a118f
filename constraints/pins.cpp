#include "constraints/pins.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

#include "mesh/base/errors.h"

namespace drape {
namespace {

std::vector<int> chosen(const PinVertices& rule, const TriangleMesh& mesh) {
  for (int v : rule.vertices)
    if (v < 0 || v >= mesh.vertex_count())
      throw InputError("pins: vertex " + std::to_string(v) + " is not in the mesh, which has vertices 0 to " +
                       std::to_string(mesh.vertex_count() - 1));
  if (rule.vertices.empty()) throw InputError("pins: the list of vertices is empty; name at least one");
  return rule.vertices;
}

std::vector<int> chosen(const PinBox& rule, const TriangleMesh& mesh) {
  std::vector<int> inside;
  const Eigen::AlignedBox3d box(rule.lower, rule.upper);
  Eigen::AlignedBox3d cloth;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3& x = mesh.positions[i];
    cloth.extend(x);
    if (box.contains(x)) inside.push_back(i);
  }
  if (inside.empty()) {
    std::ostringstream message;
    const Eigen::IOFormat row(6, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
    message << "pins: the box " << box.min().transpose().format(row) << " to "
            << box.max().transpose().format(row) << " m holds no vertex; the cloth reaches from "
            << cloth.min().transpose().format(row) << " to " << cloth.max().transpose().format(row) << " m";
    throw InputError(message.str());
  }
  return inside;
}

std::vector<int> chosen(const PinGroup& rule, const TriangleMesh& mesh) {
  std::string known;
  for (const VertexGroup& group : mesh.groups) {
    if (group.name == rule.name && !group.vertices.empty()) return group.vertices;
    known += (known.empty() ? "" : ", ") + group.name;
  }
  throw InputError("pins: the mesh has no group '" + rule.name + "'; " +
                   (known.empty() ? "it has no groups" : "its groups are: " + known));
}

std::vector<int> chosen(const PinEnd& rule, const TriangleMesh& mesh) {
  return {rule.last ? mesh.vertex_count() - 1 : 0};
}

}  // namespace

std::vector<int> select(const PinRule& rule, const TriangleMesh& mesh) {
  std::vector<int> vertices = std::visit([&](const auto& r) { return chosen(r, mesh); }, rule);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace drape
