#include "mesh/triangles/tear.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include "mesh/base/errors.h"

namespace drape {
namespace {

bool names_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Sets of corners; corner 3 t + k is corner k of triangle t. The lowest corner of a set stands for it.
class CornerSets {
 public:
  explicit CornerSets(std::size_t corners) : lower_(corners) { std::iota(lower_.begin(), lower_.end(), 0); }
  int first(int corner) {
    while (lower_[corner] != corner) corner = lower_[corner] = lower_[lower_[corner]];
    return corner;
  }
  void join(int one, int other) {
    one = first(one), other = first(other);
    lower_[std::max(one, other)] = std::min(one, other);
  }

 private:
  std::vector<int> lower_;
};

struct Side {
  CutEdge edge;   // the lower vertex first
  int low, high;  // the corners there
};

std::vector<Side> sides_by_edge(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& v = mesh.triangles[t];
    if (names_twice(v)) continue;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, from = 3 * t + k, to = 3 * t + l;
      sides.push_back(v[k] < v[l] ? Side{{v[k], v[l]}, from, to} : Side{{v[l], v[k]}, to, from});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& s, const Side& t) { return std::tie(s.edge, s.low) < std::tie(t.edge, t.low); });
  return sides;
}

std::vector<CutEdge> sorted_cuts(const std::vector<CutEdge>& cuts) {
  std::vector<CutEdge> sorted;
  sorted.reserve(cuts.size());
  for (const auto& [a, b] : cuts) sorted.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

void check_edges(const std::vector<CutEdge>& cuts, const std::vector<Side>& sides) {
  const auto before = [](const Side& side, const CutEdge& edge) { return side.edge < edge; };
  for (const CutEdge& cut : cuts) {
    const auto found = std::lower_bound(sides.begin(), sides.end(), cut, before);
    if (found == sides.end() || found->edge != cut)
      throw InputError("cut between the vertices " + std::to_string(cut.first) + " and " +
                       std::to_string(cut.second) + " (from 0): no edge of the mesh joins them");
  }
}

// Joins the corners of triangles that name the same three vertices.
void join_equal(const TriangleMesh& mesh, CornerSets& sets) {
  struct Entry {
    Triangle sorted;
    int triangle;
  };
  std::vector<Entry> entries;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (names_twice(mesh.triangles[t])) continue;
    entries.push_back({mesh.triangles[t], t});
    std::sort(entries.back().sorted.begin(), entries.back().sorted.end());
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& s, const Entry& t) {
    return std::tie(s.sorted, s.triangle) < std::tie(t.sorted, t.triangle);
  });
  for (std::size_t e = 1; e < entries.size(); ++e) {
    if (entries[e].sorted != entries[e - 1].sorted) continue;
    const int one = entries[e - 1].triangle, other = entries[e].triangle;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        if (mesh.triangles[one][k] == mesh.triangles[other][l]) sets.join(3 * one + k, 3 * other + l);
  }
}

CornerSets fans(const TriangleMesh& mesh, const std::vector<Side>& sides, const std::vector<CutEdge>& cuts) {
  CornerSets sets(3 * mesh.triangles.size());
  for (std::size_t s = 1; s < sides.size(); ++s) {
    const Side &one = sides[s - 1], &other = sides[s];
    if (one.edge != other.edge || std::binary_search(cuts.begin(), cuts.end(), one.edge)) continue;
    sets.join(one.low, other.low);
    sets.join(one.high, other.high);
  }
  join_equal(mesh, sets);
  return sets;
}

// The mesh with a copy of its vertex for all sets of corners there but the lowest one. `set` tells the lowest
// corner of the set that a corner is in, or -1 where the corner keeps its vertex.
template <class Set>
TornTriangles with_copies(const TriangleMesh& mesh, const Set& set) {
  std::vector<std::pair<int, int>> first_corners;  // (vertex, lowest corner) of every set
  const int corners = 3 * mesh.triangle_count();
  for (int c = 0; c < corners; ++c)
    if (set(c) == c) first_corners.emplace_back(mesh.triangles[c / 3][c % 3], c);
  std::sort(first_corners.begin(), first_corners.end());
  TornTriangles torn{mesh.triangles, {}};
  std::vector<int> vertex_of(static_cast<std::size_t>(corners),
                             -1);  // of the set that begins with this corner; -1: its own
  for (std::size_t k = 1; k < first_corners.size(); ++k) {
    const auto [vertex, corner] = first_corners[k];
    if (first_corners[k - 1].first != vertex) continue;
    vertex_of[corner] = mesh.vertex_count() + static_cast<int>(torn.copy_of.size());
    torn.copy_of.push_back(vertex);
  }
  for (int c = 0; c < corners; ++c)
    if (const int first = set(c); first >= 0 && vertex_of[first] >= 0)
      torn.triangles[c / 3][c % 3] = vertex_of[first];
  return torn;
}

}  // namespace

TornTriangles torn_triangles(const TriangleMesh& mesh, const std::vector<CutEdge>& cuts) {
  const std::vector<CutEdge> sorted = sorted_cuts(cuts);
  const std::vector<Side> sides = sides_by_edge(mesh);
  check_edges(sorted, sides);
  CornerSets sets = fans(mesh, sides, sorted);
  std::vector<char> at_cut(mesh.positions.size(), 0);
  for (const auto& [a, b] : sorted) at_cut[a] = at_cut[b] = 1;

  return with_copies(mesh, [&](int c) {
    const Triangle& t = mesh.triangles[c / 3];
    return names_twice(t) || !at_cut[t[c % 3]] ? -1 : sets.first(c);
  });
}

TornTriangles divided_triangles(const TriangleMesh& mesh, const std::vector<Triangle>& parts) {
  std::map<std::pair<int, int>, int> lowest;  // (vertex, part) -> corner
  for (int c = 0; c < 3 * mesh.triangle_count(); ++c)
    lowest.try_emplace({mesh.triangles[c / 3][c % 3], parts[c / 3][c % 3]}, c);
  return with_copies(mesh, [&](int c) {
    return lowest.at({mesh.triangles[c / 3][c % 3], parts[c / 3][c % 3]});
  });
}

}  // namespace drape
