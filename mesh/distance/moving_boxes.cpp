#include "mesh/distance/moving_boxes.h"

#include <utility>

#include "mesh/base/parallel.h"

namespace drape::internal {
namespace {

constexpr double farthest_origin = 0.2;  // from the middle, in sizes

struct Extent {
  Eigen::AlignedBox3d box;
  Extent& operator+=(const Extent& other) {
    box.extend(other.box);
    return *this;
  }
};

}  // namespace

MovingBoxes::MovingBoxes(const std::vector<Face>& faces, const std::vector<Vec3>& places, int most_faces,
                         int first_kind, const std::vector<char>& still)
    : most_faces_(most_faces) {
  std::vector<std::pair<Vec3, int>> middles;
  middles.reserve(faces.size());
  for (const Face& f : faces)
    middles.emplace_back((places[f.v[0]] + places[f.v[1]] + places[f.v[2]]) / 3,
                         static_cast<int>(middles.size()));
  grow(middles, 0, static_cast<int>(middles.size()));
  for (const auto& [middle, face] : middles) order_.push_back(face);
  int below = 0;
  for (int child = 0; child < 4; ++child) below += make_patches(0, child, below);
  fitted_for_.assign(patches_.size(), -1);
  std::vector<char> face_moves(faces.size(), 1);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Triangle& v = faces[f].v;
    if (!still.empty()) face_moves[f] = !(still[v[0]] && still[v[1]] && still[v[2]]);
    if (face_moves[f]) moving_faces_.push_back(static_cast<int>(f));
    if (!face_moves[f])
      for (int corner : v) box_of_still_.extend(places[corner]);
  }
  mark_kinds(first_kind, face_moves);
}

void MovingBoxes::mark_kinds(int first_kind, const std::vector<char>& face_moves) {
  const auto kind = [&](int face) {
    return (first_kind == 0 ? 3u : face < first_kind ? 1u : 2u) | (face_moves[face] ? moving : 0u);
  };
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node)
    for (int child = 0; child < 4; ++child) {
      unsigned kinds = 0;
      for (int k = 0; k < node->count[child]; ++k) kinds |= kind(order_[node->first[child] + k]);
      if (node->count[child] < 0)
        for (unsigned char below : nodes_[node->first[child]].kinds) kinds |= below;
      node->kinds[child] = static_cast<unsigned char>(kinds);
    }
}

// Makes patches of the faces below a child, which are those from `first` on in the tree's order. Returns how
// many they are.
int MovingBoxes::make_patches(int node, int child, int first) {
  int count = nodes_[node].count[child];
  const bool leaf = count >= 0;
  const std::size_t before = patches_.size();
  if (!leaf) {
    count = 0;
    for (int below = 0; below < 4; ++below)
      count += make_patches(nodes_[node].first[child], below, first + count);
  }
  if (count == 0 || (count > most_in_a_patch && !leaf)) return count;
  // What is a part of this patch is none by itself.
  for (std::size_t p = before; p < patches_.size(); ++p)
    nodes_[patches_[p].node].patch[patches_[p].child] = -1;
  patches_.resize(before);
  nodes_[node].patch[child] = static_cast<int>(before);
  patches_.push_back({node, child, first, count});
  return count;
}

// Makes a node of middles[begin, end): they are halved across their longest side, and each half is halved
// again. Halves of equal size keep the depth of the tree below log_4 of the number of faces, plus 1.
int MovingBoxes::grow(std::vector<std::pair<Vec3, int>>& middles, int begin, int end) {
  const auto halve = [&](int from, int to) {
    if (to - from < 2) return to;
    Eigen::AlignedBox3d box;
    for (int i = from; i < to; ++i) box.extend(middles[i].first);
    int axis;
    box.sizes().maxCoeff(&axis);
    const int half = from + (to - from) / 2;
    std::nth_element(middles.begin() + from, middles.begin() + half, middles.begin() + to,
                     [axis](const auto& p, const auto& q) {
                       return std::pair(p.first[axis], p.second) < std::pair(q.first[axis], q.second);
                     });
    return half;
  };
  const int node = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  const int half = halve(begin, end);
  const int cuts[] = {begin, halve(begin, half), half, halve(half, end), end};
  for (int k = 0; k < 4; ++k) {
    const int count = cuts[k + 1] - cuts[k];
    const bool leaf = count <= most_faces_;
    const int first = leaf ? cuts[k] : grow(middles, cuts[k], cuts[k + 1]);
    nodes_[node].first[k] = first;
    nodes_[node].count[k] = leaf ? count : -1;
  }
  return node;
}

void MovingBoxes::store(const EndBoxes& boxes, Node& node, int child) const {
  for (std::size_t s = 0; s < 2; ++s)
    for (int k = 0; k < 3; ++k) {
      node.lower[s][k][child] = static_cast<float>(boxes[s].min()[k] - origin_[k]);
      node.upper[s][k][child] = static_cast<float>(boxes[s].max()[k] - origin_[k]);
    }
}

void MovingBoxes::fit_leaf(Node& node, int child, const std::vector<Face>& faces,
                           const std::vector<Vec3>& start, const std::vector<Vec3>& end) const {
  EndBoxes boxes;
  for (int i = node.first[child]; i < node.first[child] + node.count[child]; ++i)
    for (int v : faces[order_[i]].v) {
      boxes[0].extend(start[v]);
      boxes[1].extend(end[v]);
    }
  store(boxes, node, child);
}

void MovingBoxes::fit_node(Node& node, int child) const {
  const Node& below = nodes_[node.first[child]];
  for (int s = 0; s < 2; ++s)
    for (int k = 0; k < 3; ++k) {
      bool first = true;
      for (int i = 0; i < 4; ++i) {
        if (below.count[i] == 0) continue;
        float &lo = node.lower[s][k][child], &hi = node.upper[s][k][child];
        lo = first ? below.lower[s][k][i] : std::min(lo, below.lower[s][k][i]);
        hi = first ? below.upper[s][k][i] : std::max(hi, below.upper[s][k][i]);
        first = false;
      }
    }
}

// All boxes are relative to one place, to which everything has to be near, for the sake of rounding. Returns
// whether it is a new one, for which all are fitted anew.
bool MovingBoxes::set_origin(const Eigen::AlignedBox3d& all, bool anew, bool at_rest) {
  const double size = all.diagonal().norm();
  at_rest_ = at_rest;
  slack_ = static_cast<float>(1e-6 * size) + std::numeric_limits<float>::min();
  if (!anew && (all.center() - origin_).norm() <= farthest_origin * size) return false;
  origin_ = all.center();
  ++origins_;
  return true;
}

void MovingBoxes::refit(const std::vector<Face>& faces, const std::vector<Vec3>& start,
                        const std::vector<Vec3>& end) {
  Eigen::AlignedBox3d box =
      sum_chunks<Work::heavy>(static_cast<int>(moving_faces_.size()), [&](int begin, int after) {
        Extent extent;
        for (int k = begin; k < after; ++k)
          for (int v : faces[moving_faces_[k]].v) extent.box.extend(start[v]).extend(end[v]);
        return extent;
      }).box;
  box.extend(box_of_still_);
  const bool all = set_origin(box, !fitted_ || box_of_still_.isEmpty(), &start == &end);
  fitted_ = true;
  const auto is_fitted_anew = [&](const Node& node, int child) {
    return all || (node.kinds[child] & moving) != 0;
  };
  for_chunks<Work::heavy>(static_cast<int>(nodes_.size()), [&](int begin, int after) {
    for (int n = begin; n < after; ++n)
      for (int child = 0; child < 4; ++child)
        if (nodes_[n].count[child] > 0 && is_fitted_anew(nodes_[n], child))
          fit_leaf(nodes_[n], child, faces, start, end);
  });
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node)  // a node stands before those below it
    for (int child = 0; child < 4; ++child)
      if (node->count[child] < 0 && is_fitted_anew(*node, child)) fit_node(*node, child);
}

void MovingBoxes::refit_patches(const std::vector<int>& from, const std::vector<int>& vertices,
                                const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
  const int patches = static_cast<int>(patches_.size());
  if (patch_boxes_.empty()) mark_above_patches();
  patch_boxes_.resize(patches_.size());
  for_chunks<Work::heavy>(patches, [&](int begin, int after) {
    for (int p = begin; p < after; ++p) {
      patch_boxes_[p] = {};
      for (int k = from[p]; k < from[p + 1]; ++k) {
        patch_boxes_[p][0].extend(start[vertices[k]]);
        patch_boxes_[p][1].extend(end[vertices[k]]);
      }
    }
  });
  Eigen::AlignedBox3d all;
  for (const EndBoxes& boxes : patch_boxes_) all.extend(boxes[0]).extend(boxes[1]);
  set_origin(all, box_of_still_.isEmpty(), &start == &end);
  fitted_ = false;
  for (int p = 0; p < patches; ++p) store(patch_boxes_[p], nodes_[patches_[p].node], patches_[p].child);
  for (auto above = above_patches_.rbegin(); above != above_patches_.rend(); ++above)
    fit_node(nodes_[above->first], above->second);
}

void MovingBoxes::refit_within(int patch, const std::vector<Face>& faces, const std::vector<Vec3>& start,
                               const std::vector<Vec3>& end) {
  const auto& [node, child, first, count] = patches_[patch];
  if ((nodes_[node].kinds[child] & moving) == 0 && fitted_for_[patch] == origins_) return;
  fitted_for_[patch] = origins_;
  if (nodes_[node].count[child] < 0) fit_below(node, child, faces, start, end);
}

// Fits what is below a child of a node, and the child.
void MovingBoxes::fit_below(int node, int child, const std::vector<Face>& faces,
                            const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
  const int below = nodes_[node].first[child];
  for (int i = 0; i < 4; ++i) {
    if (nodes_[below].count[i] > 0) fit_leaf(nodes_[below], i, faces, start, end);
    if (nodes_[below].count[i] < 0) fit_below(below, i, faces, start, end);
  }
  fit_node(nodes_[node], child);
}

void MovingBoxes::mark_above_patches() {
  std::vector<char> within(nodes_.size(), 0);
  for (int n = 0; n < static_cast<int>(nodes_.size()); ++n)
    for (int child = 0; child < 4; ++child) {
      if (nodes_[n].count[child] >= 0) continue;
      const bool inside = within[n] != 0 || nodes_[n].patch[child] >= 0;
      within[nodes_[n].first[child]] = inside;
      if (!inside) above_patches_.emplace_back(n, child);
    }
}

// Which children of a node come within the margin of a child of another along all axes at a common s.
unsigned MovingBoxes::near_children(int node, int child, int other, float margin) const {
  typedef float Floats __attribute__((vector_size(16)));
  const Node &a = nodes_[node], &b = nodes_[other];
  const auto load = [](const Four& four) { return *reinterpret_cast<const Floats*>(four.data()); };
  constexpr Floats zero = {0, 0, 0, 0};
  if (a.count[child] == 0) return 0;
  const auto those = [&b](auto near) {
    unsigned children = 0;
    for (int k = 0; k < 4; ++k)
      if (b.count[k] != 0 && near[k] != 0) children |= 1u << k;
    return children;
  };
  if (at_rest_) {
    const auto near = [&](std::size_t k) {
      return (a.upper[0][k][child] - load(b.lower[0][k]) + margin >= zero) &
             (load(b.upper[0][k]) - a.lower[0][k][child] + margin >= zero);
    };
    return those(near(0) & near(1) & near(2));
  }
  Floats enter = zero, leave = zero + 1;  // the s at which they are near along all axes looked at so far
  const auto keep = [&](Floats at_0, Floats at_1) {
    const Floats at = at_0 / (at_0 - at_1);
    const auto far_0 = at_0 < zero, far_1 = at_1 < zero;
    enter = far_0 && (at > enter || far_1) ? (far_1 ? zero + 2 : at) : enter;
    leave = !far_0 && far_1 && at < leave ? at : leave;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    keep(a.upper[0][k][child] - load(b.lower[0][k]) + margin,
         a.upper[1][k][child] - load(b.lower[1][k]) + margin);
    keep(load(b.upper[0][k]) - a.lower[0][k][child] + margin,
         load(b.upper[1][k]) - a.lower[1][k][child] + margin);
  }
  // Rounding moves both ends of the span by a few parts in ten millions.
  return those(enter <= leave + 1e-5f);
}

}  // namespace drape::internal
