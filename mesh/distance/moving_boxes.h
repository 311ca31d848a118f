// A tree of boxes about triangles whose corners go straight from one place to another while s goes from 0 to
// 1.
//   lower(s) = (1 - s) lower(0) + s lower(1),  upper(s) likewise: no corner leaves its box on the way
// Every node has four boxes. The tree halves the faces at the median when it is made, and is refitted to the
// places of every later step. The boxes are floats relative to a place near the middle of the surface, and
// the four of a node stand side by side, so that a search measures four at once (Eigen::AlignedBox holds only
// one). The effect of rounding is less than `slack`, by which a search looks farther. So no triangle that
// counts is left out, and further triangles that a search proposes do not change any answer.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mesh/distance/surface_faces.h"

namespace drape::internal {

class MovingBoxes {
 public:
  // Groups the faces by where they are when the vertices are at these places, up to `most_faces` in a box.
  // Pairs are asked for between the first `first_kind` faces and the others alone; 0: between all. still:
  // of each vertex, whether it is at the same place in all steps; none is where nothing is given.
  MovingBoxes(const std::vector<Face>& faces, const std::vector<Vec3>& places, int most_faces = 4,
              int first_kind = 0, const std::vector<char>& still = {});

  // Fits the boxes to a step: those of what moves, and all where the surface as a whole has gone far.
  // Allocates nothing.
  void refit(const std::vector<Face>& faces, const std::vector<Vec3>& start, const std::vector<Vec3>& end);

  // The same in two parts, where pairs_of_patches() is asked for few patches: first the boxes about patches,
  // which is enough for near_patches(), and then those within each patch that is asked for. `vertices` lists
  // those of patch p from place from[p] to from[p + 1]. Several threads may call refit_within(), each for
  // other patches. What searches all of the tree, near() and along(), needs refit().
  void refit_patches(const std::vector<int>& from, const std::vector<int>& vertices,
                     const std::vector<Vec3>& start, const std::vector<Vec3>& end);
  void refit_within(int patch, const std::vector<Face>& faces, const std::vector<Vec3>& start,
                    const std::vector<Vec3>& end);

  // Calls ask(face) for every face whose box at s is within the distance of interest from x, nearer boxes
  // first. ask returns the squared distance [m^2] that is of interest from then on. Nothing is asked when x
  // is not finite.
  template <class Ask>
  void near(const Vec3& x, double s, const Ask& ask) const;

  // Calls ask(face) for every face whose box is met by the straight way from x0 (at s = 0) to x1 (at s = 1)
  // at some s in [from, the last answer], or passed within `beside` [m]. ask returns the s up to which
  // crossings are of interest from then on.
  template <class Ask>
  void along(const Vec3& x0, const Vec3& x1, double from, const Ask& ask, double beside = 0) const;

  // The faces in patches of up to so many that lie beside each other, where most_faces is no more.
  static constexpr int most_in_a_patch = 32;
  struct Patch {
    int node, child;   // where in the tree
    int first, count;  // which faces of the tree's order
  };
  const std::vector<Patch>& patches() const { return patches_; }
  int face(int place) const { return order_[place]; }  // in the tree's order
  // Calls meet(p, q), p <= q, once for every two patches that can come within the margin [m] at some s and
  // have pairs to ask for, and with p = q for those within a patch. meet returns whether to go on; returns
  // false when it did not.
  template <class Meet>
  bool near_patches(const Meet& meet, double margin) const;
  // Calls ask(face, other) once for every two faces of two patches, or within one, that can come within the
  // margin of each other at some s: their boxes come as near along each axis at a common s. ask returns
  // whether to go on; returns false when it did not.
  template <class Ask>
  bool pairs_of_patches(int first, int second, const Ask& ask, double margin) const;

 private:
  using Four = Eigen::Array<float, 4, 1>;
  struct Node {
    std::array<std::array<Four, 3>, 2> lower{}, upper{};  // at s = 0 and at s = 1; x, y and z
    std::array<int, 4> first{}, count{};                  // range of faces in order_; count -1: a node
    std::array<unsigned char, 4> kinds{};                 // bits of the kinds of faces below, and `moving`
    std::array<int, 4> patch{-1, -1, -1, -1};             // which patch a child is; -1: none
  };
  struct Waiting {
    int first, count;
    float squared;
  };
  static constexpr unsigned char moving = 4;  // a bit of Node::kinds: not all of the vertices below are still
  static constexpr int deepest = 64;          // most entries of a search's stack: three per level

  // Calls meet(node, child, other node, its child) for what comes near below a child of a node and below
  // those children of another that are marked in `others`, down to where ends(node, child). Where both are
  // the same: for what comes near within it. Returns false as soon as meet does.
  template <class Ends, class Meet>
  bool pairs_between(int node, int child, int other, unsigned others, float margin, const Ends& ends,
                     const Meet& meet) const;
  template <class Ends, class Meet>
  bool pairs_within(int node, int child, float margin, const Ends& ends, const Meet& meet) const;
  struct IsLeaf {
    const MovingBoxes* boxes;
    bool operator()(int node, int child) const { return boxes->nodes_[node].count[child] >= 0; }
  };
  template <class Ask>
  auto ask_faces(const Ask& ask) const;
  float reach_of(double margin) const { return static_cast<float>(margin * (1 + 1e-6)) + slack_; }
  static unsigned after(int child) { return ~(2u * (1u << child) - 1u); }
  unsigned near_children(int node, int child, int other, float margin) const;
  int make_patches(int node, int child, int first);
  void mark_kinds(int first_kind, const std::vector<char>& face_moves);
  // Whether faces of different kinds are below both.
  static bool differ(unsigned char a, unsigned char b) {
    return (a & b >> 1 & 1u) != 0 || (a >> 1 & b & 1u) != 0;
  }

  int grow(std::vector<std::pair<Vec3, int>>& middles, int begin, int end);
  void fit_leaf(Node& node, int child, const std::vector<Face>& faces, const std::vector<Vec3>& start,
                const std::vector<Vec3>& end) const;
  void fit_node(Node& node, int child) const;
  using EndBoxes = std::array<Eigen::AlignedBox3d, 2>;  // at both ends of the motion
  void store(const EndBoxes& boxes, Node& node, int child) const;
  bool set_origin(const Eigen::AlignedBox3d& all, bool anew, bool at_rest);
  void fit_below(int node, int child, const std::vector<Face>& faces, const std::vector<Vec3>& start,
                 const std::vector<Vec3>& end);
  void mark_above_patches();

  std::vector<Node> nodes_;  // parents before their children
  std::vector<int> order_;   // face numbers, leaf by leaf
  std::vector<Patch> patches_;
  std::vector<std::pair<int, int>> above_patches_;  // nodes and their children, parents first
  std::vector<EndBoxes> patch_boxes_;               // scratch [m]
  std::vector<long> fitted_for_;  // the number of the origin for which each patch was fitted within
  long origins_ = 0;              // that there have been
  int most_faces_;                // of a leaf
  Vec3 origin_ = Vec3::Zero();
  float slack_ = 0;                   // m
  bool at_rest_ = false;              // whether start and end are the same
  std::vector<int> moving_faces_;     // with a vertex that is not still
  Eigen::AlignedBox3d box_of_still_;  // m, of the others
  bool fitted_ = false;
};

template <class Ask>
void MovingBoxes::near(const Vec3& x, double s, const Ask& ask) const {
  const Eigen::Array3f place = (x - origin_).cast<float>().array();
  const auto time = static_cast<float>(s);
  float limit = std::numeric_limits<float>::infinity();  // squared; boxes farther away are of no interest
  std::array<Waiting, deepest> stack;
  int waiting = 0;
  stack[waiting++] = {0, -1, 0};
  while (waiting > 0) {
    const Waiting at = stack[--waiting];
    if (at.squared > limit) continue;
    for (int k = 0; k < at.count; ++k) {
      const auto reach = static_cast<float>(std::sqrt(ask(order_[at.first + k])) * (1 + 1e-5)) + slack_;
      limit = std::min(limit, reach * reach);
    }
    if (at.count >= 0) continue;
    const Node& node = nodes_[at.first];
    Four squared = Four::Zero();
    for (int k = 0; k < 3; ++k) {
      const Four lower = node.lower[0][k] + time * (node.lower[1][k] - node.lower[0][k]);
      const Four upper = node.upper[0][k] + time * (node.upper[1][k] - node.upper[0][k]);
      const Four below = lower - place[k], above = place[k] - upper;
      const Four beside = below.max(above).max(0.0f);
      squared += beside * beside;
    }
    const int from = waiting;
    for (int k = 0; k < 4; ++k) {
      if (node.count[k] == 0 || !(squared[k] <= limit)) continue;
      int i = waiting++;
      for (; i > from && stack[i - 1].squared < squared[k]; --i) stack[i] = stack[i - 1];
      stack[i] = {node.first[k], node.count[k], squared[k]};
    }
  }
}

template <class Ask>
void MovingBoxes::along(const Vec3& x0, const Vec3& x1, double from, const Ask& ask, double beside) const {
  const Vec3 place = x0 - origin_, target = x1 - origin_;
  const double slack = slack_ + beside;
  double until = 1;
  std::array<Waiting, deepest> stack;
  int waiting = 0;
  stack[waiting++] = {0, -1, 0};
  while (waiting > 0) {
    const Waiting at = stack[--waiting];
    for (int k = 0; k < at.count; ++k) until = std::min(until, ask(order_[at.first + k]));
    if (at.count >= 0) continue;
    const Node& node = nodes_[at.first];
    for (int child = 0; child < 4; ++child) {
      double enter = from, leave = node.count[child] == 0 ? -1 : until;
      // Shortens [enter, leave] to the s where a quantity that goes linearly from at_0 to at_1 is not
      // negative.
      const auto keep = [&](double at_0, double at_1) {
        if (at_0 < 0 && at_1 < 0) leave = -1;
        if (at_0 < 0 && at_1 >= 0) enter = std::max(enter, at_0 / (at_0 - at_1));
        if (at_0 >= 0 && at_1 < 0) leave = std::min(leave, at_0 / (at_0 - at_1));
      };
      for (int k = 0; k < 3; ++k) {
        keep(place[k] - node.lower[0][k][child] + slack, target[k] - node.lower[1][k][child] + slack);
        keep(node.upper[0][k][child] - place[k] + slack, node.upper[1][k][child] - target[k] + slack);
      }
      if (enter <= leave) stack[waiting++] = {node.first[child], node.count[child], 0};
    }
  }
}

// All faces of one leaf with all of another, or with each other.
template <class Ask>
auto MovingBoxes::ask_faces(const Ask& ask) const {
  return [this, &ask](int node, int child, int other, int of_other) {
    const int first = nodes_[node].first[child], end = first + nodes_[node].count[child];
    const bool same = node == other && child == of_other;
    const int second = nodes_[other].first[of_other], second_end = second + nodes_[other].count[of_other];
    for (int i = first; i < end; ++i)
      for (int k = same ? i + 1 : second; k < second_end; ++k)
        if (!ask(order_[i], order_[k])) return false;
    return true;
  };
}

template <class Meet>
bool MovingBoxes::near_patches(const Meet& meet, double margin) const {
  const float reach = reach_of(margin);
  const auto is_patch = [this](int node, int child) { return nodes_[node].patch[child] >= 0; };
  const auto tell = [&](int node, int child, int other, int of_other) {
    const auto [p, q] = std::minmax(nodes_[node].patch[child], nodes_[other].patch[of_other]);
    return meet(p, q);
  };
  for (int child = 0; child < 4; ++child)
    if (!pairs_between(0, child, 0, 1u << child | (near_children(0, child, 0, reach) & after(child)), reach,
                       is_patch, tell))
      return false;
  return true;
}

template <class Ask>
bool MovingBoxes::pairs_of_patches(int first, int second, const Ask& ask, double margin) const {
  const Patch &p = patches_[first], &q = patches_[second];
  return pairs_between(p.node, p.child, q.node, 1u << q.child, reach_of(margin), IsLeaf{this},
                       ask_faces(ask));
}

template <class Ends, class Meet>
bool MovingBoxes::pairs_within(int node, int child, float margin, const Ends& ends, const Meet& meet) const {
  if (!differ(nodes_[node].kinds[child], nodes_[node].kinds[child])) return true;
  if (ends(node, child)) return meet(node, child, node, child);
  const int below = nodes_[node].first[child];
  for (int i = 0; i < 4; ++i)
    if (!pairs_between(below, i, below, 1u << i | (near_children(below, i, below, margin) & after(i)), margin,
                       ends, meet))
      return false;
  return true;
}

template <class Ends, class Meet>
bool MovingBoxes::pairs_between(int node, int child, int other, unsigned others, float margin,
                                const Ends& ends, const Meet& meet) const {
  const int below = nodes_[node].first[child];
  const bool end = ends(node, child);
  for (int k = 0; k < 4; ++k) {
    if ((others >> k & 1u) == 0 || !differ(nodes_[node].kinds[child], nodes_[other].kinds[k])) continue;
    const int other_below = nodes_[other].first[k];
    const bool other_end = ends(other, k);
    if (node == other && child == k) {
      if (!pairs_within(node, child, margin, ends, meet)) return false;
    } else if (end && other_end) {
      if (!meet(node, child, other, k)) return false;
    } else if (other_end) {
      if (!pairs_between(other, k, below, near_children(other, k, below, margin), margin, ends, meet))
        return false;
    } else if (end) {
      const unsigned near = near_children(node, child, other_below, margin);
      if (!pairs_between(node, child, other_below, near, margin, ends, meet)) return false;
    } else {
      for (int i = 0; i < 4; ++i)
        if (!pairs_between(below, i, other_below, near_children(below, i, other_below, margin), margin, ends,
                           meet))
          return false;
    }
  }
  return true;
}

}  // namespace drape::internal
