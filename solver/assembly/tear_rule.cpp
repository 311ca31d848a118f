#include "solver/assembly/tear_rule.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "mesh/triangles/topology.h"

namespace drape::internal {
namespace {

CutEdge sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

template <class T>
T value(const std::vector<T>& by_vertex, int v) {
  const auto k = static_cast<std::size_t>(v);
  return k < by_vertex.size() ? by_vertex[k] : T{};
}

// Whether a tear ends there, which so far has parted the vertices before it.
bool is_tip(int v, const Tearing& tearing) {
  return value(tearing.at_cut, v) != 0 && value(tearing.rests_until, v) == 0;
}

bool another_may_begin(const Tearing& tearing, double t) { return t >= tearing.last + draw_back; }

// The vertices round one, in order; of a closed fan the last is beside the first.
struct Fan {
  std::vector<int> around;
  bool closed;
};

// How a vertex is parted.
struct Parted {
  std::vector<int> ends;  // of the edges that are cut there
  double pull;            // sigma
  bool at_border;
};

class TearSearch {
 public:
  TearSearch(TearingCloth cloth, const Tearing& tearing, double t)
      : cloth_(std::move(cloth)), tearing_(tearing), t_(t) {
    sort_edges();
    sort_triangles();
  }

  std::vector<CutEdge> cuts() {
    std::vector<StrainedEdge> over;
    for (const StrainedEdge& e : cloth_.edges)
      if (e.strain > tearing_.limit && !draws_back(e.a, tearing_, t_) && !draws_back(e.b, tearing_, t_))
        over.push_back(e);
    std::stable_sort(over.begin(), over.end(),
                     [](const StrainedEdge& e, const StrainedEdge& f) { return e.strain > f.strain; });
    for (const StrainedEdge& e : over) part_an_end(e, true);
    if (!cuts_.empty() || !another_may_begin(tearing_, t_)) return cuts_;
    for (const StrainedEdge& e : over) {
      part_an_end(e, false);
      if (!cuts_.empty()) break;
    }
    return cuts_;
  }

 private:
  Vec3 place(int v) const { return cloth_.x[static_cast<std::size_t>(v)]; }

  void sort_edges() {
    auto& edges = cloth_.edges;
    std::sort(edges.begin(), edges.end(), [](const StrainedEdge& e, const StrainedEdge& f) {
      return std::tuple(e.a, e.b, -e.strain) < std::tuple(f.a, f.b, -f.strain);
    });
    const auto same = [](const StrainedEdge& e, const StrainedEdge& f) { return e.a == f.a && e.b == f.b; };
    edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  }

  // The triangles at vertex v: triangles_[first_[v]] up to triangles_[first_[v + 1]].
  void sort_triangles() {
    first_.assign(cloth_.x.size() + 1, 0);
    const std::vector<int> counted = counted_triangles(cloth_.mesh);
    const auto corners = [&](const auto& use) {
      for (const int t : counted)
        for (const int v : cloth_.mesh.triangles[static_cast<std::size_t>(t)])
          use(static_cast<std::size_t>(v), t);
    };
    corners([&](std::size_t v, int) { ++first_[v + 1]; });
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    triangles_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    corners([&](std::size_t v, int t) { triangles_[next[v]++] = t; });
    used_.assign(cloth_.x.size(), 0);
  }

  // Nothing where the triangles round the vertex are no single fan.
  std::optional<Fan> fan(int vertex) const {
    std::vector<std::pair<int, int>>
        sides;  // the two other corners of each triangle, and the other way round
    const auto v = static_cast<std::size_t>(vertex);
    for (std::size_t k = first_[v]; k < first_[v + 1]; ++k) {
      const Triangle& t = cloth_.mesh.triangles[static_cast<std::size_t>(triangles_[k])];
      const std::size_t at = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
      sides.emplace_back(t[(at + 1) % 3], t[(at + 2) % 3]);
      sides.emplace_back(t[(at + 2) % 3], t[(at + 1) % 3]);
    }
    if (sides.empty()) return {};
    std::sort(sides.begin(), sides.end());
    const auto beside = [&](int one) {
      return std::equal_range(sides.begin(), sides.end(), std::pair(one, 0),
                              [](const auto& s, const auto& t) { return s.first < t.first; });
    };
    int begin = sides.front().first;
    bool closed = true;
    for (const auto& [one, other] : sides) {
      const auto [from, to] = beside(one);
      if (to - from > 2) return {};
      if (to - from == 1 && std::exchange(closed, false)) begin = one;
    }
    Fan found{{begin}, closed};
    for (int before = -1, here = begin;;) {
      const auto [from, to] = beside(here);
      const int next = from->second != before ? from->second : to - from == 2 ? (from + 1)->second : -1;
      if (next < 0 || next == begin) break;
      found.around.push_back(next);
      before = std::exchange(here, next);
    }
    const std::size_t triangles = found.around.size() - (closed ? 0 : 1);
    if (2 * triangles != sides.size()) return {};
    return found;
  }

  Vec3 pull(int at, int towards) const {
    const auto [a, b] = sorted(at, towards);
    const auto edge =
        std::lower_bound(cloth_.edges.begin(), cloth_.edges.end(), std::pair(a, b),
                         [](const StrainedEdge& e, const auto& key) { return std::pair(e.a, e.b) < key; });
    const bool known = edge != cloth_.edges.end() && edge->a == a && edge->b == b;
    const Vec3 way = place(towards) - place(at);
    if (!known || !(edge->strain > 0) || !(way.norm() > 0)) return Vec3::Zero();
    return edge->strain * way.normalized();
  }

  bool may_cut(int vertex, int end) const {
    const CutEdge edge = sorted(vertex, end);
    return used_[static_cast<std::size_t>(end)] == 0 &&
           !std::binary_search(cloth_.never_cut.begin(), cloth_.never_cut.end(), edge);
  }

  // How the vertex is best parted; nothing where it cannot be, or where too little pulls.
  std::optional<Parted> best(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    if (cloth_.held[v] != 0 || used_[v] != 0) return {};
    const std::optional<Fan> found = fan(vertex);
    if (!found) return {};
    const std::vector<int>& around = found->around;
    const std::size_t n = around.size();
    std::vector<Vec3> pulls, sums = {Vec3::Zero()};  // sums[k]: of the first k pulls
    for (const int end : around) {
      pulls.push_back(pull(vertex, end));
      sums.push_back(sums.back() + pulls.back());
    }
    std::optional<Parted> most;
    // A has the edges between p and q.
    const auto look = [&](std::vector<int> ends, const Vec3& of_a) {
      const Vec3 of_b = sums.back() - of_a, n_ab = (of_a - of_b).normalized();
      const double sigma = std::min(n_ab.dot(of_a), -n_ab.dot(of_b));
      constexpr double more = 1 + 1e-9;  // of those that differ by round-off the first is taken
      if (sigma >= 0.5 * tearing_.limit && (!most || sigma > more * most->pull))
        most = {std::move(ends), sigma, !found->closed};
    };
    if (!found->closed) {
      for (std::size_t p = 1; p + 1 < n; ++p)
        if (may_cut(vertex, around[p])) look({around[p]}, sums[p] + 0.5 * pulls[p]);
      return most;
    }
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n && may_cut(vertex, around[p]); ++q)
        if (may_cut(vertex, around[q]))
          look({around[p], around[q]}, sums[q] - sums[p + 1] + 0.5 * (pulls[p] + pulls[q]));
    return most;
  }

  // grow: only an end that is the tip of a tear.
  void part_an_end(const StrainedEdge& edge, bool grow) {
    std::optional<Parted> chosen;
    int vertex = -1;
    for (const int end : {edge.a, edge.b}) {
      if (grow && !is_tip(end, tearing_)) continue;
      std::optional<Parted> parted = best(end);
      if (!parted || (chosen && std::tuple(parted->at_border, parted->pull) <=
                                    std::tuple(chosen->at_border, chosen->pull)))
        continue;
      chosen = std::move(parted);
      vertex = end;
    }
    if (!chosen) return;
    used_[static_cast<std::size_t>(vertex)] = 1;
    for (const int end : chosen->ends) {
      used_[static_cast<std::size_t>(end)] = 1;
      cuts_.push_back(sorted(vertex, end));
    }
  }

  TearingCloth cloth_;
  const Tearing& tearing_;
  double t_;
  std::vector<std::size_t> first_;
  std::vector<int> triangles_;
  std::vector<char> used_;  // by vertex: whether it is at a cut of this step
  std::vector<CutEdge> cuts_;
};

}  // namespace

bool may_part(int vertex, const Tearing& tearing, double t) {
  return is_tip(vertex, tearing) || another_may_begin(tearing, t);
}

bool draws_back(int vertex, const Tearing& tearing, double t) {
  return t < value(tearing.rests_until, vertex);
}

std::vector<CutEdge> edges_to_cut(TearingCloth cloth, const Tearing& tearing, double t) {
  return TearSearch(std::move(cloth), tearing, t).cuts();
}

void note_cuts(const std::vector<CutEdge>& cuts, const std::vector<int>& copies, double t,
               std::size_t vertices, Tearing& tearing) {
  tearing.at_cut.resize(vertices, 0);
  tearing.rests_until.resize(vertices, 0);
  for (const auto& [a, b] : cuts)
    for (const int v : {a, b}) tearing.at_cut[static_cast<std::size_t>(v)] = 1;
  for (std::size_t k = 0; k < copies.size(); ++k)
    for (const std::size_t v : {vertices - copies.size() + k, static_cast<std::size_t>(copies[k])}) {
      tearing.at_cut[v] = 1;
      tearing.rests_until[v] = t + draw_back;
    }
  tearing.cuts += static_cast<int>(cuts.size());
  tearing.last = t;
}

}  // namespace drape::internal
