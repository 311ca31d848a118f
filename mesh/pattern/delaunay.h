// A constrained Delaunay triangulation of a box in the plane, to which points are added one by one.
//   Edges that carry a piece (of an outline or a line) are never flipped; any other edge is locally Delaunay:
//   no corner opposite it lies inside the circle of the triangle on its other side, by exact predicates.
// A point is added by splitting a triangle in three, or the two triangles of an edge in four, and flipping
// edges afterwards [Lawson 1977]. A missing edge is brought in by flipping the edges that cross it
// [Sloan 1993].
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
  struct Corner {  // corner `i` of triangle `t`, and the edge opposite it
    int t = -1, i = 0;
  };
  struct Face {
    std::array<int, 3> v;      // counter-clockwise
    std::array<int, 3> next;   // the triangle across the edge opposite each corner, or -1
    std::array<int, 3> piece;  // the piece that lies on that edge, or -1
    bool inside = false;
  };
  static constexpr int kBoxCorners = 4;  // the corners of the box are vertices 0 to 3

  // Makes a triangulation around the points in this box; its own corners are well away from them.
  explicit Delaunay(const Eigen::AlignedBox2d& box);

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Vec2>& points() const { return points_; }
  int face_at(int vertex) const { return face_at_[vertex]; }

  // Where x is, found by walking straight from the middle of a triangle. `corner` names the triangle that
  // holds x or, if `blocked`, the first edge on the way that carries a piece. `on_edge`: x lies on the edge
  // opposite corner i.
  struct Place {
    Corner corner;
    bool blocked = false, on_edge = false;
    int vertex = -1;  // x is this vertex
  };
  Place locate(const Vec2& x, int from, bool stop_at_pieces) const;

  bool fits(Corner edge, const Vec2& x) const;  // whether split() would take x
  int add(const Vec2& x, const Place& place);   // the new vertex; an edge on which it lies carries no piece
  Corner find_edge(int a, int b) const;         // t = -1 when a and b are not joined
  Corner edge_of(int a, int b) const;           // find_edge() of two vertices that are joined
  // Joins a and b by an edge that carries the piece. Returns false, with nothing done, when a and b are one
  // vertex or when another vertex or piece is in the way.
  bool force_edge(int a, int b, int piece);
  // Splits an edge that carries a piece at x; the half at vertex `a` then carries piece_a. x may lie beside
  // the edge, as long as the four new triangles keep their sense; if they do not, -1 is returned and nothing
  // is done.
  int split(Corner edge, const Vec2& x, int a, int piece_a, int piece_b);
  // Marks the triangles inside: the box is outside, and the side changes across every piece whose `closed` is
  // set.
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
      }  // at a corner of the box: goes on from the other side of the start
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
