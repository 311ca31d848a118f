#include "mesh/obj/quad_grid.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "mesh/obj/obj.h"

namespace drape {
namespace {

using Quad = QuadGrid::Quad;

std::vector<Quad> quads_of(const TriangleMesh& mesh) {
  if (!mesh.document) throw InputError("the mesh has triangles only, no faces of four corners");
  const ObjDocument& document = *mesh.document;
  std::vector<Quad> quads;
  quads.reserve(document.face_count());
  for (std::size_t f = 0; f < document.face_count(); ++f) {
    const std::size_t begin = document.face_start[f], count = document.face_start[f + 1] - begin;
    std::set<int> corners;
    for (std::size_t k = 0; k < count; ++k) corners.insert(document.corners[begin + k].v);
    if (count != 4 || corners.size() != 4)
      throw InputError("face " + std::to_string(f + 1) + " of the file has " +
                       std::to_string(corners.size()) +
                       (corners.size() == count ? " corners" : " different corners") + ", not 4");
    Quad quad;
    for (std::size_t k = 0; k < 4; ++k) quad[k] = document.corners[begin + k].v;
    quads.push_back(quad);
  }
  return quads;
}

// A side of a quad: its vertices in order, the quad, and which of its four sides it is.
struct Side {
  int low, high, quad, number;
};

class GridSearch {
 public:
  GridSearch(std::vector<Quad> quads, int vertices) : across_(quads.size(), {-1, -1, -1, -1}) {
    grid_.quads = std::move(quads);
    find_neighbours();
    check_vertices(vertices);
  }

  QuadGrid search() {
    for (int q = 0; q < static_cast<int>(grid_.quads.size()); ++q)
      for (int side = 0; side < 4; ++side) look_across(q, side);
    const auto order = [](const QuadGrid::Straight& s) {
      return std::tie(s.a, s.c, s.m, s.quad_a, s.quad_c);
    };
    const auto before = [&](const auto& s, const auto& t) { return order(s) < order(t); };
    const auto same = [&](const auto& s, const auto& t) { return order(s) == order(t); };
    for (auto* list : {&grid_.rows, &grid_.diagonals}) {
      std::sort(list->begin(), list->end(), before);
      list->erase(std::unique(list->begin(), list->end(), same), list->end());
    }
    return std::move(grid_);
  }

 private:
  int corner(int q, int k) const { return grid_.quads[q][k & 3]; }
  int across(int q, int side) const { return across_[q][side & 3]; }
  int place(int q, int vertex) const {  // position of a vertex in a quad
    int k = 0;
    while (corner(q, k) != vertex) ++k;
    return k;
  }

  void find_neighbours() {
    for (int q = 0; q < static_cast<int>(grid_.quads.size()); ++q)
      for (int k = 0; k < 4; ++k) {
        const auto [low, high] = std::minmax({corner(q, k), corner(q, k + 1)});
        sides_.push_back({low, high, q, k});
      }
    std::sort(sides_.begin(), sides_.end(), [](const Side& s, const Side& t) {
      return std::tie(s.low, s.high, s.quad) < std::tie(t.low, t.high, t.quad);
    });
    for (std::size_t first = 0, last = 0; first < sides_.size(); first = last) {
      const Side& s = sides_[first];
      while (last < sides_.size() && sides_[last].low == s.low && sides_[last].high == s.high) ++last;
      if (last - first > 2)
        throw InputError("the edge of vertices " + std::to_string(s.low) + " and " + std::to_string(s.high) +
                         " has " + std::to_string(last - first) + " quads, a grid has one or two");
      if (last - first < 2) continue;
      const Side& t = sides_[first + 1];
      across_[s.quad][s.number] = t.quad;
      across_[t.quad][t.number] = s.quad;
    }
  }

  // Checks every vertex by the numbers of quads and edges around it. A vertex inside has 4 quads and 4 edges.
  // A vertex on a boundary has at most three quads, four where a slit ends, and one edge more than quads. Two
  // corners of holes may touch.
  void check_vertices(int vertices) const {
    std::vector<int> quads(static_cast<std::size_t>(vertices), 0), edges = quads;
    for (const Quad& quad : grid_.quads)
      for (int v : quad) ++quads[v];
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      if (k > 0 && sides_[k].low == sides_[k - 1].low && sides_[k].high == sides_[k - 1].high) continue;
      ++edges[sides_[k].low];
      ++edges[sides_[k].high];
    }
    for (std::size_t v = 0; v < quads.size(); ++v) {
      const int q = quads[v], e = edges[v];
      const bool inside = q == 4 && e == 4, boundary = q <= 4 && e == q + 1, touch = q == 2 && e == 4;
      if (q == 0 || inside || boundary || touch) continue;
      throw InputError("vertex " + std::to_string(v) + " has " + std::to_string(q) + " quads around it" +
                       (e == q ? ", a vertex inside a grid has 4" : ", on a boundary a grid has at most 4"));
    }
  }

  // Looks at the quad beyond a side. Two rows go on there. At either end of the side a diagonal leads into
  // the quad beyond the next side.
  void look_across(int q, int side) {
    const int beyond = across(q, side);
    if (beyond < 0) return;
    for (int end : {side, side + 1}) {
      const int m = corner(q, end), before = corner(q, end == side ? side - 1 : side + 2);
      const int k = place(beyond, m);
      // In the quad beyond, the vertex m has two sides: the shared one and another.
      const int other = corner(q, end == side ? side + 1 : side);
      const bool shared_comes_after = corner(beyond, k + 1) == other;
      add(grid_.rows, before, m, corner(beyond, shared_comes_after ? k - 1 : k + 1), q, beyond);
      const int next = across(beyond, shared_comes_after ? k - 1 : k);
      if (next < 0 || next == q) continue;
      add(grid_.diagonals, corner(q, end + 2), m, corner(next, place(next, m) + 2), q, next);
    }
  }

  static void add(std::vector<QuadGrid::Straight>& list, int a, int m, int c, int quad_a, int quad_c) {
    if (a == c) return;  // the grid is a tube of two quads
    if (a < c)
      list.push_back({a, m, c, quad_a, quad_c});
    else
      list.push_back({c, m, a, quad_c, quad_a});
  }

  QuadGrid grid_;
  std::vector<Side> sides_;
  std::vector<std::array<int, 4>> across_;  // the quad beyond each side, -1: none
};

}  // namespace

QuadGrid quad_grid(const TriangleMesh& mesh) {
  return GridSearch(quads_of(mesh), mesh.vertex_count()).search();
}

}  // namespace drape
