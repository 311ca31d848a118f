// Topology by sorting: the three sides of every triangle are put into buckets by their lower vertex, and each
// small bucket is sorted by the upper one. This takes linear time and no hashing, and gives the same lists
// whatever the order of the triangles.
#include "mesh/triangles/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <compare>
#include <numeric>
#include <utility>

#include "mesh/triangles/normals.h"

namespace drape {

namespace {

bool names_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// One side of a triangle; it stands in the bucket of its lower vertex.
struct Side {
  int b;         // upper vertex
  int opposite;  // third vertex of the triangle
  int triangle;
  bool forward;  // the triangle runs from the lower vertex to b
};

struct Sides {
  std::vector<std::size_t> start;  // vertices + 1 entries into sides
  std::vector<Side> sides;         // within each bucket sorted by (b, opposite)
};

// Puts the items 0 .. count-1 into buckets by key(item); place(item, slot) stores each item. Returns the
// start of every bucket.
template <class Key, class Place>
std::vector<std::size_t> fill_buckets(int buckets, std::size_t count, const Key& key, const Place& place) {
  std::vector<std::size_t> start(static_cast<std::size_t>(buckets) + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++start[key(i) + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < count; ++i) place(i, next[key(i)]++);
  return start;
}

Sides sort_sides(const TriangleMesh& mesh) {
  const std::vector<int> counted = counted_triangles(mesh);
  Sides result;
  result.sides.resize(3 * counted.size());
  const auto ends = [&](std::size_t i) {
    const Triangle& t = mesh.triangles[counted[i / 3]];
    return std::pair(t[i % 3], t[(i + 1) % 3]);
  };
  result.start = fill_buckets(
      mesh.vertex_count(), result.sides.size(),
      [&](std::size_t i) {
        const auto [from, to] = ends(i);
        return std::min(from, to);
      },
      [&](std::size_t i, std::size_t slot) {
        const auto [from, to] = ends(i);
        result.sides[slot] = {std::max(from, to), mesh.triangles[counted[i / 3]][(i + 2) % 3], counted[i / 3],
                              from < to};
      });
  for (int a = 0; a < mesh.vertex_count(); ++a) {
    std::sort(
        result.sides.data() + result.start[a], result.sides.data() + result.start[a + 1],
        [](const Side& s, const Side& t) { return std::tie(s.b, s.opposite) < std::tie(t.b, t.opposite); });
  }
  return result;
}

// Calls visit(a, first, last) for the sides [first, last) of every edge, in the order of (a, b).
template <class Visit>
void for_each_edge(const Sides& sides, const Visit& visit) {
  for (std::size_t a = 0; a + 1 < sides.start.size(); ++a) {
    const Side* const end = sides.sides.data() + sides.start[a + 1];
    const Side* last = nullptr;
    for (const Side* first = sides.sides.data() + sides.start[a]; first != end; first = last) {
      last = first;
      while (last != end && last->b == first->b) ++last;
      visit(static_cast<int>(a), first, last);
    }
  }
}

}  // namespace

std::vector<int> counted_triangles(const TriangleMesh& mesh) {
  struct Entry {
    int middle, high, number;
  };
  std::vector<int> valid;
  valid.reserve(mesh.triangles.size());
  for (int i = 0; i < mesh.triangle_count(); ++i) {
    if (!names_twice(mesh.triangles[i])) valid.push_back(i);
  }
  std::vector<Entry> entries(valid.size());
  const auto lowest = [&](std::size_t i) {
    const Triangle& t = mesh.triangles[valid[i]];
    return std::min({t[0], t[1], t[2]});
  };
  const std::vector<std::size_t> start =
      fill_buckets(mesh.vertex_count(), valid.size(), lowest, [&](std::size_t i, std::size_t slot) {
        const Triangle& t = mesh.triangles[valid[i]];
        const int low = lowest(i), high = std::max({t[0], t[1], t[2]});
        entries[slot] = {t[0] ^ t[1] ^ t[2] ^ low ^ high, high, valid[i]};
      });
  std::vector<char> repeated(mesh.triangles.size(), 0);
  for (std::size_t a = 0; a + 1 < start.size(); ++a) {
    std::sort(entries.data() + start[a], entries.data() + start[a + 1], [](const Entry& s, const Entry& t) {
      return std::tie(s.middle, s.high, s.number) < std::tie(t.middle, t.high, t.number);
    });
    for (std::size_t k = start[a] + 1; k < start[a + 1]; ++k) {
      const Entry &one = entries[k - 1], &two = entries[k];
      if (one.middle == two.middle && one.high == two.high) repeated[two.number] = 1;
    }
  }
  std::erase_if(valid, [&](int i) { return repeated[i] != 0; });
  return valid;
}

std::vector<Edge> edges(const TriangleMesh& mesh) {
  const Sides sides = sort_sides(mesh);
  std::vector<Edge> list;
  list.reserve(sides.sides.size() / 2);
  for_each_edge(sides, [&](int a, const Side* first, const Side* last) {
    const auto forward = std::count_if(first, last, [](const Side& s) { return s.forward; });
    list.push_back({a, first->b, static_cast<int>(last - first), static_cast<int>(forward)});
  });
  return list;
}

std::vector<Hinge> hinges(const TriangleMesh& mesh) {
  const Sides sides = sort_sides(mesh);
  std::vector<Hinge> by_edge;
  by_edge.reserve(sides.sides.size() / 2);
  for_each_edge(sides, [&](int a, const Side* first, const Side* last) {
    for (const Side* s = first; s != last; ++s) {
      for (const Side* t = s + 1; t != last; ++t) {
        if (s->opposite != t->opposite)
          by_edge.push_back({a, s->b, s->opposite, t->opposite, s->triangle, t->triangle});
      }
    }
  });
  std::vector<Hinge> list(by_edge.size());
  const std::vector<std::size_t> start = fill_buckets(
      mesh.vertex_count(), by_edge.size(), [&](std::size_t i) { return by_edge[i].c; },
      [&](std::size_t i, std::size_t slot) { list[slot] = by_edge[i]; });
  for (std::size_t c = 0; c + 1 < start.size(); ++c) {
    std::sort(list.data() + start[c], list.data() + start[c + 1], [](const Hinge& s, const Hinge& t) {
      return std::tie(s.d, s.a, s.b) < std::tie(t.d, t.a, t.b);
    });
  }
  return list;
}

std::vector<Diagonal> diagonals(const TriangleMesh& mesh) {
  std::vector<Diagonal> list;
  for (const Hinge& hinge : hinges(mesh)) {
    const bool again = !list.empty() && list.back().c == hinge.c && list.back().d == hinge.d;
    if (!again) list.push_back({hinge.c, hinge.d});
  }
  return list;
}

namespace {

// The boundary edges around each vertex, in both directions, and the walk that takes every edge once.
class BoundaryWalk {
 public:
  explicit BoundaryWalk(const TriangleMesh& mesh) {
    for (const Edge& edge : edges(mesh)) {
      if (edge.triangles == 1) edges_.push_back(edge);
    }
    const auto end = [&](std::size_t i) { return i % 2 == 0 ? edges_[i / 2].a : edges_[i / 2].b; };
    around_.resize(2 * edges_.size());
    start_ = fill_buckets(mesh.vertex_count(), around_.size(), end,
                          [&](std::size_t i, std::size_t slot) { around_[slot] = static_cast<int>(i / 2); });
    next_.assign(start_.begin(), start_.end());
    used_.assign(edges_.size(), 0);
    place_.assign(mesh.vertex_count(), -1);
  }

  std::vector<std::vector<int>> loops() {
    for (const Edge& edge : edges_) walk_from(edge.a);
    std::sort(loops_.begin(), loops_.end());
    return std::move(loops_);
  }

 private:
  // The lowest edge at v that has not been walked yet, or -1 if there is none.
  int take_edge(int v) {
    std::size_t& next = next_[v];
    while (next < start_[v + 1] && used_[around_[next]]) ++next;
    if (next == start_[v + 1]) return -1;
    used_[around_[next]] = 1;
    return around_[next];
  }

  void walk_from(int v) {
    path_.assign(1, v);
    path_edges_.clear();
    place_[v] = 0;
    while (!path_.empty()) {
      const int here = path_.back(), edge = take_edge(here);
      if (edge < 0) {  // a dead end (only on non-manifold meshes) or all done: back up
        place_[here] = -1;
        path_.pop_back();
        if (!path_edges_.empty()) path_edges_.pop_back();
        continue;
      }
      const int there = edges_[edge].a == here ? edges_[edge].b : edges_[edge].a;
      path_edges_.push_back(edge);
      if (place_[there] >= 0) {
        close_loop(static_cast<std::size_t>(place_[there]));
      } else {
        place_[there] = static_cast<int>(path_.size());
        path_.push_back(there);
      }
    }
  }

  // Closes a loop: the path from `from` on has come back to where it began.
  void close_loop(std::size_t from) {
    std::vector<int> loop(path_.begin() + static_cast<std::ptrdiff_t>(from), path_.end());
    int with = 0;  // edges that run as their triangle runs, less those that run against it
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Edge& edge = edges_[path_edges_[from + k]];
      with += (edge.a == loop[k]) == (edge.forward == 1) ? 1 : -1;
    }
    for (std::size_t k = from + 1; k < path_.size(); ++k) place_[path_[k]] = -1;
    path_.resize(from + 1);
    path_edges_.resize(from);
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    if (with < 0 || (with == 0 && loop.back() < loop[1])) std::reverse(loop.begin() + 1, loop.end());
    loops_.push_back(std::move(loop));
  }

  std::vector<Edge> edges_;
  std::vector<std::size_t> start_, next_;
  std::vector<int> around_;  // edge numbers, vertex by vertex
  std::vector<char> used_;
  std::vector<int> path_, path_edges_, place_;  // place_: where a vertex stands in the path, or -1
  std::vector<std::vector<int>> loops_;
};

}  // namespace

std::vector<std::vector<int>> boundary_loops(const TriangleMesh& mesh) { return BoundaryWalk(mesh).loops(); }

std::vector<int> welded(const std::vector<Vec3>& positions) {
  std::vector<int> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    for (int k = 0; k < 3; ++k)  // a weak order: NaN must not break the sorting
      if (const auto between = std::weak_order(positions[i][k], positions[j][k]); std::is_neq(between))
        return std::is_lt(between);
    return i < j;
  });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && positions[order[k]] == positions[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

std::vector<Hole> holes(const TriangleMesh& mesh) {
  TriangleMesh whole = mesh;
  const std::vector<int> weld = welded(mesh.positions);
  for (Triangle& t : whole.triangles)
    for (int& v : t) v = weld[v];
  std::vector<Hole> all;
  for (const std::vector<int>& loop : boundary_loops(whole)) {
    Hole hole{static_cast<int>(loop.size()), 0, 0, Vec3::Zero()};
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3& x = mesh.positions[loop[i]];
      hole.circumference += (mesh.positions[loop[(i + 1) % loop.size()]] - x).norm();
      hole.centre += x / static_cast<double>(loop.size());
      box.extend(x);
    }
    hole.width = box.diagonal().norm();
    all.push_back(hole);
  }
  std::stable_sort(all.begin(), all.end(), [](const Hole& a, const Hole& b) { return a.width > b.width; });
  return all;
}

double triangle_area(const TriangleMesh& mesh, const Triangle& t) {
  return twice_area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).norm() / 2;
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) { return vertex_areas(mesh, mesh); }

std::vector<double> vertex_areas(const TriangleMesh& mesh, const TriangleMesh& rest) {
  std::vector<double> areas(mesh.positions.size(), 0.0);
  for (const int i : counted_triangles(mesh)) {
    const double third = triangle_area(rest, rest.triangles[i]) / 3;
    for (const int v : mesh.triangles[i]) areas[v] += third;
  }
  return areas;
}

std::vector<int> connected_pieces(const TriangleMesh& mesh) {
  std::vector<int> lower(mesh.positions.size());  // union-find: towards the lowest vertex of the piece
  for (std::size_t v = 0; v < lower.size(); ++v) lower[v] = static_cast<int>(v);
  const auto root = [&](int v) {
    while (lower[v] != v) v = lower[v] = lower[lower[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    if (names_twice(t)) continue;
    for (int k = 1; k < 3; ++k) {
      const int p = root(t[0]), q = root(t[k]);
      lower[std::max(p, q)] = std::min(p, q);
    }
  }
  std::vector<int> piece(lower.size());
  int count = 0;
  for (std::size_t v = 0; v < lower.size(); ++v) {
    piece[v] = lower[v] == static_cast<int>(v) ? count++ : piece[root(static_cast<int>(v))];
  }
  return piece;
}

}  // namespace drape
