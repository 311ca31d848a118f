#include "solver/assembly/coincident.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "mesh/triangles/extent.h"
#include "mesh/triangles/topology.h"

namespace drape::internal {

std::vector<int> layers_below(const std::vector<Cloth>& cloths, const TriangleMesh& mesh) {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;  // those of the mesh last
  const auto add = [&](const TriangleMesh& part) {
    const int first = static_cast<int>(positions.size());
    positions.insert(positions.end(), part.positions.begin(), part.positions.end());
    for (const Triangle& t : part.triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  };
  for (const Cloth& cloth : cloths) add(cloth.mesh);
  const int first_vertex = static_cast<int>(positions.size());
  add(mesh);

  struct Placed {
    std::array<int, 3> place, corners;  // both sorted
    bool operator<(const Placed& other) const {
      return std::tie(place, corners) < std::tie(other.place, other.corners);
    }
  };
  const std::vector<int> place_of = welded(positions);
  std::vector<Placed> placed;
  placed.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    Placed one{{place_of[t[0]], place_of[t[1]], place_of[t[2]]}, {t[0], t[1], t[2]}};
    std::sort(one.place.begin(), one.place.end());
    std::sort(one.corners.begin(), one.corners.end());
    placed.push_back(one);
  }
  std::sort(placed.begin(), placed.end());

  std::vector<int> below(mesh.positions.size(), 0);
  int count = 0;
  for (std::size_t k = 1; k < placed.size(); ++k) {
    if (placed[k].place != placed[k - 1].place)
      count = 0;
    else if (placed[k].corners != placed[k - 1].corners)
      ++count;
    for (int v : placed[k].corners)
      if (v >= first_vertex) below[v - first_vertex] = std::max(below[v - first_vertex], count);
  }
  return below;
}

std::vector<std::pair<int, int>> all_at_one_place(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> pairs;
  const std::vector<int> first = welded(mesh.positions);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (first[v] != v) pairs.emplace_back(first[v], v);
  return pairs;
}

int triangles_on_others(const TriangleMesh& mesh) {
  const std::vector<int> place = welded(mesh.positions);
  std::vector<std::pair<Triangle, Triangle>> all;  // places and vertices, both sorted
  for (const Triangle& t : mesh.triangles) {
    Triangle places = {place[t[0]], place[t[1]], place[t[2]]}, vertices = t;
    std::ranges::sort(places);
    std::ranges::sort(vertices);
    if (places[0] != places[1] && places[1] != places[2]) all.emplace_back(places, vertices);
  }
  std::ranges::sort(all);
  int count = 0;
  for (std::size_t k = 1; k < all.size(); ++k)
    count += all[k].first == all[k - 1].first && all[k].second != all[k - 1].second;
  return count;
}

std::vector<std::pair<int, int>> joined_at_one_place(const TriangleMesh& mesh, const TriangleMesh& rest) {
  constexpr double none = 1e-9;
  const auto no_length = [](const TriangleMesh& of, int a, int b, double size) {
    return (of.positions[a] - of.positions[b]).norm() <= none * size;
  };
  const double size = box_of(mesh.positions, mesh.triangles).diagonal().norm(),
               at_rest = box_of(rest.positions, rest.triangles).diagonal().norm();
  std::vector<std::pair<int, int>> pairs;
  for (const int k : counted_triangles(mesh))
    for (std::size_t side = 0; side < 3; ++side) {
      const Triangle &t = mesh.triangles[k], &r = rest.triangles[k];
      const std::size_t next = (side + 1) % 3;
      if (no_length(mesh, t[side], t[next], size) && no_length(rest, r[side], r[next], at_rest))
        pairs.emplace_back(t[side], t[next]);
    }
  return pairs;
}

}  // namespace drape::internal
