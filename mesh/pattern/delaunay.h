// A constrained Delaunay triangulation of a box in the plane, to which points are added one by one.
//   Edges that carry a piece (of an outline or a line) are never flipped; any other edge is locally Delaunay:
//   no corner opposite it lies inside the circle of the triangle on its other side, by exact predicates.
// Adding: split a triangle in three or an edge's two triangles in four, then flip [Lawson 1977]. A missing
// edge is brought in by flipping what crosses it [Sloan 1993]. Internal to the library (not installed).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <deque>
#include <utility>
#include <vector>

#include "mesh/pattern/curve.h"

namespace drape::internal {

class Delaunay {
 public:
  struct Corner {  // the corner `i` of triangle `t`, and the edge opposite it
    int t = -1, i = 0;
  };
  struct Face {
    std::array<int, 3> v;      // counter-clockwise
    std::array<int, 3> next;   // triangle across the edge opposite each corner, -1: none
    std::array<int, 3> piece;  // that lies on that edge, -1: none
    bool inside = false;
  };
  static constexpr int kBoxCorners = 4;  // vertices 0 to 3

  // Around the points in this box, well away from them.
  explicit Delaunay(const Eigen::AlignedBox2d& box);

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Vec2>& points() const { return points_; }
  int face_at(int vertex) const { return face_at_[vertex]; }

  // Where x is, walking straight from the middle of a triangle: the triangle, or with `blocked` the first
  // piece's edge on the way. `on_edge`: x is on the edge opposite corner i.
  struct Place {
    Corner corner;
    bool blocked = false, on_edge = false;
    int vertex = -1;  // x is this vertex
  };
  Place locate(const Vec2& x, int from, bool stop_at_pieces) const;

  bool fits(Corner edge, const Vec2& x) const;  // whether split() would take x
  int add(const Vec2& x, const Place& place);   // the new vertex; an edge it is on carries no piece
  Corner find_edge(int a, int b) const;         // t = -1: a and b are not joined
  Corner edge_of(int a, int b) const;           // find_edge() of two that are joined
  // False, with nothing done: a and b are one vertex, or another vertex or piece is in the way.
  bool force_edge(int a, int b, int piece);
  // Puts x in the middle of an edge with a piece; the half at vertex `a` of it carries piece_a. x may lie
  // beside the edge, as long as the four triangles keep their sense; if not, -1 and nothing is done.
  int split(Corner edge, const Vec2& x, int a, int piece_a, int piece_b);
  // Outside is where the box is, and with every piece whose `closed` is set the side changes.
  void mark_inside(const std::vector<char>& closed);

  // Calls f(triangle) for all triangles around a vertex.
  template <class F>
  void around(int vertex, const F& f) const {
    const int start = face_at(vertex);
    for (const bool clockwise : {true, false}) {
      for (int t = start; t >= 0;) {
        if (clockwise || t != start) f(t);
        const Face& face = faces_[t];
        const int i = index_of(face, vertex);
        t = face.next[clockwise ? before(i) : after(i)];
        if (t == start) return;
      }  // at a corner of the box: what is on the other side of the start
    }
  }
  static int after(int i) { return i == 2 ? 0 : i + 1; }
  static int before(int i) { return i == 0 ? 2 : i - 1; }
  static int index_of(const Face& face, int vertex) {
    return face.v[0] == vertex ? 0 : face.v[1] == vertex ? 1 : 2;
  }

 private:
  Face& face(int t) { return faces_[t]; }
  const Face& face(int t) const { return faces_[t]; }
  const Vec2& at(int v) const { return points_[v]; }
  int new_vertex(const Vec2& x);
  void join(int t, int i, int other, int piece);
  Corner across(Corner c) const;
  bool convex(Corner c) const;
  void flip(Corner c);
  void legalise();
  int split_edge(Corner edge, const Vec2& x, int piece_a, int piece_b);
  bool crossed_edges(int a, int b, std::deque<std::pair<int, int>>& crossed) const;

  std::vector<Vec2> points_;
  std::vector<Face> faces_;
  std::vector<int> face_at_;
  std::vector<Corner> suspects_;
};

}  // namespace drape::internal
