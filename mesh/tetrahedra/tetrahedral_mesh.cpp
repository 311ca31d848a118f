#include "mesh/tetrahedra/tetrahedral_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

namespace drape {
namespace {

constexpr int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};  // corners, normals outwards

struct Face {
  Triangle sorted;  // vertices, ascending
  bool even;        // whether the face runs through them in this order
  int tetrahedron, number;
};

Triangle corners(const TetrahedralMesh& mesh, const Face& face) {
  const Tetrahedron& t = mesh.tetrahedra[face.tetrahedron];
  const int(&k)[3] = faces[face.number];
  return {t[k[0]], t[k[1]], t[k[2]]};
}

// All faces of all tetrahedra; equal ones stand side by side, by tetrahedron.
std::vector<Face> sorted_faces(const TetrahedralMesh& mesh) {
  std::vector<Face> all;
  all.reserve(4 * mesh.tetrahedra.size());
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    for (int f = 0; f < 4; ++f) {
      Face face{{}, false, t, f};
      const Triangle v = corners(mesh, face);
      face.sorted = v;
      std::sort(face.sorted.begin(), face.sorted.end());
      const auto lowest = std::min_element(v.begin(), v.end()) - v.begin();
      face.even = v[(lowest + 1) % 3] < v[(lowest + 2) % 3];
      all.push_back(face);
    }
  }
  std::sort(all.begin(), all.end(), [](const Face& a, const Face& b) {
    return std::tie(a.sorted, a.tetrahedron) < std::tie(b.sorted, b.tetrahedron);
  });
  return all;
}

}  // namespace

double volume_of(const TetrahedralMesh& mesh, const Tetrahedron& t) {
  const Vec3& a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).dot(mesh.positions[t[3]] - a) / 6;
}

std::vector<double> vertex_volumes(const TetrahedralMesh& mesh) {
  std::vector<double> volumes(mesh.positions.size(), 0);
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (const int v : t) volumes[v] += volume_of(mesh, t) / 4;
  return volumes;
}

std::vector<std::pair<int, int>> edges_of(const TetrahedralMesh& mesh) {
  std::vector<std::pair<int, int>> list;
  list.reserve(6 * mesh.tetrahedra.size());
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < k; ++l) list.emplace_back(std::min(t[k], t[l]), std::max(t[k], t[l]));
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

TriangleMesh surface_of(const TetrahedralMesh& mesh, std::vector<int>& vertices) {
  const std::vector<Face> all = sorted_faces(mesh);
  std::vector<Face> outer;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool before = k > 0 && all[k - 1].sorted == all[k].sorted;
    const bool after = k + 1 < all.size() && all[k + 1].sorted == all[k].sorted;
    if (!before && !after) outer.push_back(all[k]);
  }
  std::sort(outer.begin(), outer.end(), [](const Face& a, const Face& b) {
    return std::tie(a.tetrahedron, a.number) < std::tie(b.tetrahedron, b.number);
  });
  std::vector<int> number(mesh.positions.size(), -1);
  for (const Face& face : outer)
    for (const int v : face.sorted) number[v] = 0;
  TriangleMesh surface;
  vertices.clear();
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (number[v] < 0) continue;
    number[v] = surface.vertex_count();
    surface.positions.push_back(mesh.positions[v]);
    vertices.push_back(v);
  }
  for (const Face& face : outer) {
    const Triangle v = corners(mesh, face);
    surface.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
  }
  for (const VertexGroup& group : mesh.groups) {
    VertexGroup part{group.name, {}};
    for (const int v : group.vertices)
      if (number[v] >= 0) part.vertices.push_back(number[v]);
    if (!part.vertices.empty()) surface.groups.push_back(std::move(part));
  }
  return surface;
}

std::pair<int, int> overlapping(const TetrahedralMesh& mesh) {
  const std::vector<Face> all = sorted_faces(mesh);
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k].sorted != all[k - 1].sorted) continue;
    const bool third = k > 1 && all[k - 2].sorted == all[k].sorted;
    if (third || all[k].even == all[k - 1].even) return {all[k - 1].tetrahedron, all[k].tetrahedron};
  }
  return {-1, -1};
}

}  // namespace drape
