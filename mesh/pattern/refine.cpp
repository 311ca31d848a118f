#include "mesh/pattern/refine.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <queue>

#include "mesh/base/errors.h"
#include "mesh/pattern/sharp_corners.h"
#include "mesh/triangles/extent.h"

namespace drape::internal {
namespace {

std::size_t z(int i) { return static_cast<std::size_t>(i); }

constexpr int kBox = Delaunay::kBoxCorners;

struct Shape {  // of a triangle: squared edges opposite its corners, twice its area
  double edge[3], twice_area;
  int shortest, longest;
};

Shape shape_of(const Delaunay& mesh, const Delaunay::Face& f) {
  const Vec2 &a = mesh.points()[z(f.v[0])], &b = mesh.points()[z(f.v[1])], &c = mesh.points()[z(f.v[2])];
  Shape s{{(c - b).squaredNorm(), (a - c).squaredNorm(), (b - a).squaredNorm()},
          (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()),
          0,
          0};
  for (int i = 1; i < 3; ++i) {
    if (s.edge[i] < s.edge[s.shortest]) s.shortest = i;
    if (s.edge[i] > s.edge[s.longest]) s.longest = i;
  }
  return s;
}

Vec2 circumcentre(const Delaunay& mesh, const Delaunay::Face& f) {
  const Vec2& a = mesh.points()[z(f.v[0])];
  const Vec2 b = mesh.points()[z(f.v[1])] - a, c = mesh.points()[z(f.v[2])] - a;
  const double d = 2 * (b.x() * c.y() - b.y() * c.x()), b2 = b.squaredNorm(), c2 = c.squaredNorm();
  return a + Vec2(c.y() * b2 - b.y() * c2, b.x() * c2 - c.x() * b2) / d;
}

class Refinement {
 public:
  Refinement(const Pattern& pattern, const Sides& sides, double edge, double min_angle, long most)
      : pattern_(pattern), sides_(sides), edge_(edge), sine_(std::sin(min_angle)), left_(most) {}

  Refined run() {
    refined_.pieces = sides_.pieces;
    for (std::size_t p = 0; p < sides_.points.size(); ++p) start_panel(static_cast<int>(p));
    for (std::size_t p = 0; p < refined_.panels.size(); ++p) {
      left_ -= static_cast<long>(refined_.panels[p].points().size());
      for (std::size_t t = 0; t < refined_.panels[p].faces().size(); ++t)
        look_at(static_cast<int>(p), static_cast<int>(t));
    }
    while (left_ > 0) {
      if (!encroached_.empty()) {
        const Asked asked = encroached_.front();
        encroached_.pop_front();
        const Subsegment& piece = refined_.pieces[z(asked.piece)];
        if (piece.a == asked.a && piece.b == asked.b) split_with_twins(asked.piece);
      } else if (!bad_.empty()) {
        const Bad bad = bad_.top();
        bad_.pop();
        const Delaunay& mesh = refined_.panels[z(bad.panel)];
        if (mesh.faces()[z(bad.t)].v == bad.v) mend(bad);
      } else {
        break;
      }
    }
    return std::move(refined_);
  }

  const Sides& sides() const { return sides_; }

 private:
  struct Asked {
    int piece, a, b;
  };
  struct Bad {
    double radius2;
    int panel, t;
    std::array<int, 3> v;
    bool operator<(const Bad& o) const {
      return radius2 != o.radius2 ? radius2 < o.radius2 : panel != o.panel ? panel > o.panel : t > o.t;
    }
  };

  const ChainRun& run_of(const Subsegment& piece) const { return sides_.runs[z(piece.run)]; }
  int panel_of(const Subsegment& piece) const { return run_of(piece).panel; }

  void start_panel(int panel) {
    const std::vector<Vec2>& points = sides_.points[z(panel)];
    refined_.panels.emplace_back(box_of(points));
    Delaunay& mesh = refined_.panels.back();
    int near = 0;
    for (const Vec2& x : points) near = mesh.face_at(mesh.add(x, mesh.locate(x, near, false)));
    std::vector<char> closed(refined_.pieces.size(), 0);
    for (std::size_t i = 0; i < refined_.pieces.size(); ++i) {
      Subsegment& piece = refined_.pieces[i];
      if (panel_of(piece) != panel) continue;
      closed[i] = run_of(piece).boundary;
      if (!mesh.force_edge(piece.a + kBox, piece.b + kBox, static_cast<int>(i)))
        throw InputError(run_of(piece).where + ": meets another corner or line of panel '" +
                         pattern_.panels[z(panel)].name + "' at " + place_of(points[z(piece.a)]) +
                         "; draw them apart");
    }
    mesh.mark_inside(closed);
    for (const Subsegment& piece : refined_.pieces)
      if (panel_of(piece) == panel) check_sides(mesh, piece);
  }

  // Checks that the panel is on the left of what bounds it, and on both sides of a line.
  void check_sides(const Delaunay& mesh, const Subsegment& piece) const {
    const auto inside = [&](int a, int b) {
      const Delaunay::Corner c = mesh.edge_of(a + kBox, b + kBox);
      const Delaunay::Face& f = mesh.faces()[z(c.t)];
      const bool left = f.v[z(Delaunay::after(c.i))] == a + kBox;
      return mesh.faces()[z(left ? c.t : f.next[z(c.i)])].inside;
    };
    const ChainRun& run = run_of(piece);
    const bool left = inside(piece.a, piece.b), right = inside(piece.b, piece.a);
    if (run.boundary ? left && !right : left && right) return;
    throw InputError(
        run.where +
        (run.boundary ? ": this hole is not inside its panel '" : ": this line is not inside its panel '") +
        pattern_.panels[z(run.panel)].name + "', or in one of its holes; move it");
  }

  // Notes what a triangle asks for: that it be mended, or that a piece on it be split.
  void look_at(int panel, int t) {
    const Delaunay& mesh = refined_.panels[z(panel)];
    const Delaunay::Face& f = mesh.faces()[z(t)];
    if (!f.inside) return;
    for (int i = 0; i < 3; ++i) {
      const int p = f.piece[z(i)];
      if (p >= 0 && encroaches(mesh, p, f.v[z(i)])) {
        const Subsegment& piece = refined_.pieces[z(p)];
        if (!piece.stuck) encroached_.push_back({p, piece.a, piece.b});
      }
    }
    const Shape s = shape_of(mesh, f);
    const double product = s.edge[0] * s.edge[1] * s.edge[2] / s.edge[s.shortest];
    const bool too_long = s.edge[s.longest] > edge_ * edge_;
    const bool too_sharp = s.twice_area * s.twice_area < sine_ * sine_ * product;
    if (!too_long && (!too_sharp || at_sharp_corner(sides_, mesh, panel, f))) return;
    const double radius2 = product * s.edge[s.shortest] / (4 * s.twice_area * s.twice_area);
    bad_.push({radius2, panel, t, f.v});
  }

  bool in_circle_around(const Delaunay& mesh, const Subsegment& piece, const Vec2& x) const {
    return (mesh.points()[z(piece.a + kBox)] - x).dot(mesh.points()[z(piece.b + kBox)] - x) < 0;
  }

  bool encroaches(const Delaunay& mesh, int p, int v) const {
    const Subsegment& piece = refined_.pieces[z(p)];
    if (!in_circle_around(mesh, piece, mesh.points()[z(v)])) return false;
    const int panel = panel_of(piece);
    return !span_sharp_corner(sides_, mesh, panel, piece.a, v - kBox) &&
           !span_sharp_corner(sides_, mesh, panel, piece.b, v - kBox);
  }

  void mend(const Bad& bad) {
    Delaunay& mesh = refined_.panels[z(bad.panel)];
    const Vec2 centre = circumcentre(mesh, mesh.faces()[z(bad.t)]);
    if (!centre.allFinite()) return;
    const Delaunay::Place place = mesh.locate(centre, bad.t, true);
    in_the_way_.clear();
    if (place.blocked) {
      const int piece = mesh.faces()[z(place.corner.t)].piece[z(place.corner.i)];
      if (piece < 0) return;
      in_the_way_.push_back(piece);
    } else if (place.vertex >= 0) {
      return;
    } else {
      find_in_the_way(mesh, centre, place.corner.t);
      if (place.on_edge && mesh.faces()[z(place.corner.t)].piece[z(place.corner.i)] >= 0)
        in_the_way_.push_back(mesh.faces()[z(place.corner.t)].piece[z(place.corner.i)]);
    }
    if (in_the_way_.empty()) {
      look_around(bad.panel, mesh.add(centre, place));
      --left_;
      return;
    }
    bool done = false;
    const std::vector<Asked> asked = asked_for(in_the_way_);
    for (const Asked& a : asked) {
      const Subsegment& piece = refined_.pieces[z(a.piece)];
      if (piece.a == a.a && piece.b == a.b) done = split_with_twins(a.piece) || done;
    }
    if (done && mesh.faces()[z(bad.t)].v == bad.v) bad_.push(bad);
  }

  std::vector<Asked> asked_for(const std::vector<int>& pieces) const {
    std::vector<Asked> asked;
    asked.reserve(pieces.size());
    for (const int p : pieces) asked.push_back({p, refined_.pieces[z(p)].a, refined_.pieces[z(p)].b});
    return asked;
  }

  // Finds the pieces whose circles would hold a vertex at x that they see. They lie on the rim of the
  // triangles that the new vertex would change.
  void find_in_the_way(const Delaunay& mesh, const Vec2& x, int from) {
    visited_.assign(1, from);
    seen_.resize(std::max(seen_.size(), mesh.faces().size()), 0);
    seen_[z(from)] = ++look_;
    for (std::size_t k = 0; k < visited_.size(); ++k) {
      const Delaunay::Face& f = mesh.faces()[z(visited_[k])];
      for (std::size_t i = 0; i < 3; ++i) {
        if (f.piece[i] >= 0) {
          if (in_circle_around(mesh, refined_.pieces[z(f.piece[i])], x)) in_the_way_.push_back(f.piece[i]);
        } else if (seen_[z(f.next[i])] != look_ && holds(mesh, mesh.faces()[z(f.next[i])], x)) {
          seen_[z(f.next[i])] = look_;
          visited_.push_back(f.next[i]);
        }
      }
    }
  }

  // Whether x is in the circle of a triangle. The test is not exact, because no result depends on its last
  // bit.
  static bool holds(const Delaunay& mesh, const Delaunay::Face& f, const Vec2& x) {
    const Vec2 a = mesh.points()[z(f.v[0])] - x, b = mesh.points()[z(f.v[1])] - x,
               c = mesh.points()[z(f.v[2])] - x;
    return a.squaredNorm() * (b.x() * c.y() - b.y() * c.x()) +
               b.squaredNorm() * (c.x() * a.y() - c.y() * a.x()) +
               c.squaredNorm() * (a.x() * b.y() - a.y() * b.x()) >
           0;
  }

  void look_around(int panel, int vertex) {
    around_.clear();
    refined_.panels[z(panel)].around(vertex, [&](int t) { around_.push_back(t); });
    for (const int t : around_) look_at(panel, t);
  }

  // Splits a piece, the pieces that are sewn on it, and the other first pieces at the sharp corners of any of
  // these.
  bool split_with_twins(int p) {
    std::vector<int> ring = {p};
    for (int q = refined_.pieces[z(p)].twin; q != p; q = refined_.pieces[z(q)].twin) ring.push_back(q);
    std::vector<std::pair<Delaunay::Corner, Vec2>> places;
    for (const int q : ring) {
      const Subsegment& piece = refined_.pieces[z(q)];
      const Delaunay& mesh = refined_.panels[z(panel_of(piece))];
      const Vec2 &a = mesh.points()[z(piece.a + kBox)], &b = mesh.points()[z(piece.b + kBox)];
      const Delaunay::Corner edge = mesh.edge_of(piece.a + kBox, piece.b + kBox);
      Vec2 x = run_of(piece).curve.at((piece.f0 + piece.f1) / 2);
      if (!mesh.fits(edge, x)) x = (a + b) / 2;
      const bool can = !piece.stuck && (a - b).norm() > 2e-3 * edge_ && mesh.fits(edge, x);
      if (!can) {
        for (const int r : ring) refined_.pieces[z(r)].stuck = true;
        return false;
      }
      places.emplace_back(edge, x);
    }
    std::vector<Asked> companions;
    for (const int q : ring) add_companions(q, companions);
    for (std::size_t i = 0; i < ring.size(); ++i) split(ring[i], places[i].first, places[i].second);
    link(ring);
    for (const Asked& c : companions)
      if (refined_.pieces[z(c.piece)].a == c.a && refined_.pieces[z(c.piece)].b == c.b)
        split_with_twins(c.piece);
    return true;
  }

  static double length2(const Delaunay& mesh, const Subsegment& piece) {
    return (mesh.points()[z(piece.a + kBox)] - mesh.points()[z(piece.b + kBox)]).squaredNorm();
  }

  // Adds the pieces that are split together with p at a sharp corner. A piece half as long has been halved
  // already.
  void add_companions(int p, std::vector<Asked>& companions) const {
    const Subsegment& piece = refined_.pieces[z(p)];
    for (const bool at_end : {false, true}) {
      const int cluster = sides_.legs[z(piece.leg)].sharp[at_end];
      const int apex = corner_of(sides_, piece.leg, at_end);
      if (cluster < 0 || (at_end ? piece.b : piece.a) != apex) continue;
      const Delaunay& mesh = refined_.panels[z(panel_of(piece))];
      mesh.around(apex + kBox, [&](int t) {
        const Delaunay::Face& f = mesh.faces()[z(t)];
        for (const int q : f.piece) {
          if (q < 0 || q == p) continue;
          const Subsegment& other = refined_.pieces[z(q)];
          const bool first = (other.a == apex && sides_.legs[z(other.leg)].sharp[0] == cluster) ||
                             (other.b == apex && sides_.legs[z(other.leg)].sharp[1] == cluster);
          if (first && length2(mesh, other) > 0.5 * length2(mesh, piece))
            companions.push_back({q, other.a, other.b});
        }
      });
    }
  }

  void split(int p, Delaunay::Corner edge, const Vec2& x) {
    const int fresh = static_cast<int>(refined_.pieces.size());
    Subsegment second = refined_.pieces[z(p)];
    const int panel = panel_of(second);
    Delaunay& mesh = refined_.panels[z(panel)];
    // A twin in the same panel may have changed what is around the edge.
    edge = mesh.edge_of(second.a + kBox, second.b + kBox);
    const Vec2 middle_point = (mesh.points()[z(second.a + kBox)] + mesh.points()[z(second.b + kBox)]) / 2;
    int v = mesh.split(edge, x, second.a + kBox, p, fresh);
    if (v < 0) v = mesh.split(edge, middle_point, second.a + kBox, p, fresh);
    if (v < 0) throw InputError(run_of(second).where + ": is too finely drawn for the edge length");
    const double middle = (second.f0 + second.f1) / 2;
    refined_.pieces[z(p)].b = second.a = v - kBox;
    refined_.pieces[z(p)].f1 = second.f0 = middle;
    refined_.pieces.push_back(second);
    std::vector<int>& leg_of = sides_.leg_of[z(panel)];
    leg_of.resize(mesh.points().size() - kBox, Sides::kFree);
    leg_of[z(v - kBox)] = second.leg;
    --left_;
    look_around(panel, v);
  }

  // Links the halves of twins as twins: first with first where the runs go the same way, else first with
  // second.
  void link(const std::vector<int>& ring) {
    const int count = static_cast<int>(ring.size()), fresh = static_cast<int>(refined_.pieces.size()) - count;
    const auto half = [&](int i, bool second) {
      const bool turned = run_of(refined_.pieces[z(ring[z(i)])]).turned;
      return second != turned ? fresh + i : ring[z(i)];
    };
    for (int i = 0; i < count; ++i)
      for (const bool second : {false, true})
        refined_.pieces[z(half(i, second))].twin = half((i + 1) % count, second);
  }

  const Pattern& pattern_;
  Sides sides_;  // its leg_of grows
  const double edge_, sine_;
  long left_;  // number of vertices that may still be added
  Refined refined_;
  std::deque<Asked> encroached_;
  std::priority_queue<Bad> bad_;
  std::vector<int> in_the_way_, visited_, around_;
  std::vector<long> seen_;  // for each triangle, the last look that visited it
  long look_ = 0;
};

}  // namespace

bool at_sharp_corner(const Sides& sides, const Delaunay& mesh, int panel, const Delaunay::Face& f) {
  const int i = shape_of(mesh, f).shortest;
  const int u = f.v[z(Delaunay::after(i))] - kBox, w = f.v[z(Delaunay::before(i))] - kBox;
  return span_sharp_corner(sides, mesh, panel, u, w);
}

Refined refine(const Pattern& pattern, Sides& sides, double edge, double min_angle, long most_vertices) {
  Refinement refinement(pattern, sides, edge, min_angle, most_vertices);
  Refined refined = refinement.run();
  sides = refinement.sides();
  return refined;
}

}  // namespace drape::internal
