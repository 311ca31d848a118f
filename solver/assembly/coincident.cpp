#include "solver/assembly/coincident.h"

#include <algorithm>
#include <array>
#include <tuple>

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

}  // namespace drape::internal
