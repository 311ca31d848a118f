#include "mesh/distance/triangle_crossings.h"

#include <algorithm>
#include <array>
#include <compare>
#include <numeric>
#include <utility>

#include "mesh/base/parallel.h"
#include "mesh/distance/moving_boxes.h"
#include "mesh/distance/passing_edges.h"

namespace drape {
namespace {

using internal::Face;
using internal::MovingBoxes;

bool is_segment(const Triangle& t) { return t[1] == t[2] && t[0] != t[1]; }

struct PairPassage : Passage {
  int pair;  // place in the list of pairs

  auto where() const { return std::array{a, b, through}; }
};

class Search {
 public:
  Search(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
      : x_(positions), triangles_(triangles) {}

  // Adds the pair when the triangles cross.
  void look_at(int first, int second) {
    const Triangle &s = triangles_[first], &t = triangles_[second];
    if (internal::share_a_vertex(s, t)) return;
    const auto before = passages_.size();
    if (!look_through(first, second)) look_through(second, first);
    if (passages_.size() == before) return;
    pairs_.push_back({std::min(first, second), std::max(first, second)});
  }

  int found() const { return static_cast<int>(pairs_.size()); }
  // Takes what another search of the same triangles found, up to most_crossing_pairs in all.
  void take(const Search& other) {
    const int before = found(), most = most_crossing_pairs - before;
    for (const PairPassage& p : other.passages_)
      if (p.pair < most) passages_.push_back({p, before + p.pair});
    pairs_.insert(pairs_.end(), other.pairs_.begin(), other.pairs_.begin() + std::min(most, other.found()));
  }
  void clear() {
    pairs_.clear();
    passages_.clear();
  }
  std::vector<CrossingContour> contours();

 private:
  // Finds the edges of one triangle that pass through the other; a segment has its edge twice. True: they
  // cannot cross.
  bool look_through(int of, int through) {
    const auto before = passages_.size();
    return internal::passing_edges(x_, triangles_[of], triangles_[through], [&](int a, int b) {
      if (is_segment(triangles_[of]) && passages_.size() > before) return;
      passages_.push_back({{a, b, of, through}, static_cast<int>(pairs_.size())});
    });
  }

  Vec3 place_of(const Passage& p) const {
    return x_[p.a] + internal::share_of_way(x_, p.a, p.b, triangles_[p.through]) * (x_[p.b] - x_[p.a]);
  }

  const std::vector<Vec3>& x_;
  const std::vector<Triangle>& triangles_;
  std::vector<TrianglePair> pairs_;
  std::vector<PairPassage> passages_;
};

// Two pairs are joined when they have the passage of an edge through a triangle in common. Where only one
// pair has it, the contour ends.
std::vector<CrossingContour> Search::contours() {
  std::vector<int> root(pairs_.size());
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](int pair) {
    while (root[pair] != pair) pair = root[pair] = root[root[pair]];
    return pair;
  };
  std::sort(passages_.begin(), passages_.end(), [&](const PairPassage& p, const PairPassage& q) {
    return std::tuple(p.where(), pairs_[p.pair]) < std::tuple(q.where(), pairs_[q.pair]);
  });
  std::vector<char> ends(pairs_.size(), 0);
  std::vector<const PairPassage*> passage_of(pairs_.size(), nullptr);
  for (std::size_t k = 0; k < passages_.size();) {
    const std::size_t first = k;
    for (; k < passages_.size() && passages_[k].where() == passages_[first].where(); ++k) {
      root[root_of(passages_[k].pair)] = root_of(passages_[first].pair);
      if (!passage_of[passages_[k].pair]) passage_of[passages_[k].pair] = &passages_[k];
    }
    if (k == first + 1) ends[passages_[first].pair] = 1;
  }

  std::vector<int> order(pairs_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int p, int q) { return pairs_[p] < pairs_[q]; });
  std::vector<CrossingContour> contours;
  std::vector<int> contour_of(pairs_.size(), -1);  // by root
  for (const int pair : order) {
    int& number = contour_of[root_of(pair)];
    if (number < 0) {
      number = static_cast<int>(contours.size());
      contours.push_back({.pairs = {}, .passages = {}, .closed = true, .place = place_of(*passage_of[pair])});
    }
    contours[number].pairs.push_back(pairs_[pair]);
    if (ends[pair]) contours[number].closed = false;
  }
  for (const PairPassage& passage : passages_)
    contours[contour_of[root_of(passage.pair)]].passages.push_back(passage);
  std::stable_sort(contours.begin(), contours.end(),
                   [](const auto& a, const auto& b) { return a.pairs.size() > b.pairs.size(); });
  return contours;
}

// Calls look_at(part, face, other) for what comes near each other, up to most_crossing_pairs. Several parts
// of the search go on side by side.
template <class LookAt>
void look_at_near_ones(const MovingBoxes& boxes, bool serial, Search& search, const LookAt& look_at) {
  constexpr int parts_at_once = 64, pairs_of_a_part = 32;  // of patches of faces
  std::vector<Search> parts(parts_at_once, search);
  std::vector<std::pair<int, int>> near;
  const auto look = [&] {
    const auto count = static_cast<int>(near.size());
    const int used = (count + pairs_of_a_part - 1) / pairs_of_a_part;
    parallel_for(used, serial, [&](int part) {
      Search& here = parts[part];
      here.clear();
      const auto ask = [&](int face, int other) {
        look_at(here, face, other);
        return true;
      };
      for (int k = part * pairs_of_a_part; k < std::min(count, (part + 1) * pairs_of_a_part); ++k)
        boxes.pairs_of_patches(near[k].first, near[k].second, ask, 0);
    });
    for (int part = 0; part < used; ++part) search.take(parts[part]);
    near.clear();
    return search.found() < most_crossing_pairs;
  };
  const auto add = [&](int p, int q) {
    near.emplace_back(p, q);
    return near.size() < parts_at_once * pairs_of_a_part || look();
  };
  if (boxes.near_patches(add, 0)) look();
}

// first_kind: as of MovingBoxes, in triangles. segments: as of crossing_contours().
std::vector<CrossingContour> contours_of(const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& triangles, int first_kind,
                                         int segments) {
  std::vector<Face> faces;
  int faces_of_first = 0;
  std::vector<int> triangle_of;  // by face
  for (int k = 0; k < static_cast<int>(triangles.size()); ++k) {
    const Triangle& t = triangles[k];
    const bool may_be_segment = k + segments >= static_cast<int>(triangles.size());
    if (may_be_segment ? !is_segment(t) : t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (!std::all_of(t.begin(), t.end(), [&](int v) { return positions[v].allFinite(); })) continue;
    faces.push_back({t, {-1, -1, -1}});
    faces_of_first += k < first_kind;
    triangle_of.push_back(k);
  }
  if (faces.empty()) return {};
  constexpr int in_a_box = 1;
  MovingBoxes boxes(faces, positions, in_a_box, faces_of_first);
  boxes.refit(faces, positions, positions);
  Search search(positions, triangles);
  look_at_near_ones(boxes, static_cast<int>(faces.size()) < serial_below(Work::heavy), search,
                    [&](Search& here, int first, int second) {
                      const int a = triangle_of[first], b = triangle_of[second];
                      if (first_kind == 0 || (a < first_kind) != (b < first_kind)) here.look_at(a, b);
                    });
  return search.contours();
}

}  // namespace

std::vector<CrossingContour> crossing_contours(const std::vector<Vec3>& positions,
                                               const std::vector<Triangle>& triangles, int segments) {
  return contours_of(positions, triangles, 0, segments);
}

std::vector<CrossingContour> contours_between(const std::vector<Vec3>& positions,
                                              const std::vector<Triangle>& triangles, int count) {
  if (count == 0) return {};
  return contours_of(positions, triangles, count, 0);
}

int crossing_count(const std::vector<CrossingContour>& contours) {
  std::size_t pairs = 0;
  for (const CrossingContour& contour : contours) pairs += contour.pairs.size();
  return static_cast<int>(pairs);
}

}  // namespace drape
